#include "coordinator/frame_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "coordinator/reply_bytes.hpp"

namespace abut {

namespace {

constexpr double mebibyte = 1048576.0;

struct Frames {
  const Scene& scene;
  double limit;  // [B]
  const Document& document;

  void require(double bytes, const Description& body, const std::string& what,
               const std::string& key, const std::string& remedy) const {
    if (bytes <= limit) return;
    throw InputError(
        fmt::format("{} of body '{}' takes {:.4g} MiB, more than a frame between processes holds, "
                    "{:.4g} MiB",
                    what, body.name, bytes / mebibyte, limit / mebibyte),
        document.where(key), remedy + ", or run with --local, which has no frames.");
  }

  void description(const Description& body) const {
    double bytes = 0.0;
    for (const Port& port : body.ports) {
      const PortGeometry& surface = port.geometry;
      bytes +=
          static_cast<double>(sizeof(double) * (surface.points.size() + surface.normals.size()) +
                              surface.facets.size() + surface.offsets.size());
    }
    require(bytes, body, "the description", "bodies." + body.name + ".ports",
            "Take a coarser mesh, or ports of fewer points");
  }

  /// Without interfaces nothing is iterated, and replies tell of records alone.
  void window(const Description& body) const {
    const double records = scene.output.records_per_window;
    const bool iterated = !scene.interfaces.empty() || scene.everything() != nullptr;
    const double steps = body.step > 0.0 ? std::round(scene.time.window / body.step) : records;
    const double times = (iterated ? std::max(steps, records) : records) + 1.0;
    require(reply_bytes(body, times, records), body,
            fmt::format("the reply to a window of {:g} times", times), "time.window",
            "Give shorter windows, or ports of fewer points");
  }

  void fields(const Description& body, const FieldSize& size) const {
    double values = 0.0;
    for (const FieldInfo& field : body.fields)
      values += field.components *
                static_cast<double>(field.place == FieldPlace::nodes ? size.nodes : size.cells);
    const double grid = static_cast<double>(size.nodes) * 3.0 * sizeof(double) +
                        static_cast<double>(size.cells) * body.dim;
    require(std::max(values * sizeof(double), grid), body, "a set of fields", "output.fields",
            "Leave output.fields out, take a coarser mesh");
  }
};

}  // namespace

void check_frames(const Scene& scene, std::span<const Description* const> bodies,
                  std::span<const FieldSize> fields, std::size_t limit, const Document& document) {
  const Frames frames{scene, static_cast<double>(limit), document};
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b] == nullptr) continue;
    frames.description(*bodies[b]);
    frames.window(*bodies[b]);
    if (b < fields.size()) frames.fields(*bodies[b], fields[b]);
  }
}

}  // namespace abut
