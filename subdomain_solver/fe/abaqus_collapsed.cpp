#include "subdomain_solver/fe/abaqus_collapsed.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "base/index.hpp"

namespace abut {
namespace {

using Pair = std::pair<int, int>;

Pair edge(int a, int b) { return std::minmax(a, b); }

/// Corners of a face in turn, then the nodes between each of them and the next.
struct Face {
  std::vector<int> corners, middles;  // none of first order
};

class Collapse {
 public:
  Collapse(const AbaqusElement& whole, const std::vector<int>& alike)
      : whole_(whole), alike_(alike) {}

  std::optional<CollapsedElement> run() {
    for (const std::vector<int>& face : whole_.faces)
      if (!take(face)) return std::nullopt;
    const AbaqusElement* type =
        abaqus_shape(whole_.dim, static_cast<int>(corners_.size()), whole_.quadratic);
    if (type == nullptr || !order(*type)) return std::nullopt;
    CollapsedElement out = {*type, std::vector<int>(index(type->nodes), -1)};
    std::ranges::copy(ordered_, out.nodes.begin());
    for (const std::vector<int>& face : type->faces) {
      const std::size_t edges = edges_in(face);
      for (std::size_t k = 0; whole_.quadratic && k < edges; ++k) {
        const auto middle = middle_.find(
            edge(out.nodes[index(face[k])], out.nodes[index(face[(k + 1) % ends_in(face)])]));
        if (middle == middle_.end()) return std::nullopt;
        out.nodes[index(face[ends_in(face) + k])] = middle->second;
      }
    }
    if (std::set<int>(out.nodes.begin(), out.nodes.end()).size() != out.nodes.size())
      return std::nullopt;
    out.type.faces = faces_of(out.nodes);
    return out;
  }

 private:
  /// In the plane a face is one edge.
  std::size_t edges_in(const std::vector<int>& face) const {
    return whole_.dim == 2 ? 1 : ends_in(face);
  }
  std::size_t ends_in(const std::vector<int>& face) const {
    if (whole_.dim == 2) return 2;
    return whole_.quadratic ? face.size() / 2 : face.size();
  }

  /// A face without the edges that have shrunk. False: its corners cross, or edges disagree.
  bool take(const std::vector<int>& face) {
    Face& kept = faces_.emplace_back();
    for (std::size_t k = 0; k < edges_in(face); ++k) {
      const int a = alike_[index(face[k])], b = alike_[index(face[(k + 1) % ends_in(face)])];
      const int middle = whole_.quadratic ? alike_[index(face[ends_in(face) + k])] : a;
      corners_.insert({a, b});
      if (a == b && middle != a) return false;
      if (a == b) continue;
      if (whole_.quadratic && (middle == a || middle == b)) return false;
      if (whole_.quadratic && middle_.try_emplace(edge(a, b), middle).first->second != middle)
        return false;
      kept.corners.push_back(a);
      if (whole_.quadratic) kept.middles.push_back(middle);
      if (whole_.dim == 2) kept.corners.push_back(b);
    }
    const std::set<int> different(kept.corners.begin(), kept.corners.end());
    if (different.size() != kept.corners.size()) return false;
    if (kept.corners.size() < index(whole_.dim)) kept = {};
    return true;
  }

  /// Corners as the shape has them: from a face that looks as its first one does.
  bool order(const AbaqusElement& type) {
    std::vector<std::size_t> sizes, wanted;
    for (const Face& face : faces_)
      if (!face.corners.empty()) sizes.push_back(face.corners.size());
    for (const std::vector<int>& face : type.faces) wanted.push_back(ends_in(face));
    std::ranges::sort(sizes);
    std::vector<std::size_t> sorted = wanted;
    std::ranges::sort(sorted);
    if (sizes != sorted) return false;
    if (whole_.dim == 2) {
      for (const Face& face : faces_)
        if (!face.corners.empty()) ordered_.push_back(face.corners.front());
      return true;
    }
    const auto base = std::ranges::find_if(
        faces_, [&wanted](const Face& face) { return face.corners.size() == wanted.front(); });
    ordered_ = base->corners;
    const std::size_t first = ordered_.size();
    if (corners_.size() == first + 1) {
      for (const int corner : corners_)
        if (std::ranges::find(base->corners, corner) == base->corners.end())
          ordered_.push_back(corner);
    } else {
      for (std::size_t k = 0; k < first; ++k) ordered_.push_back(above(base->corners, k));
    }
    return std::set<int>(ordered_.begin(), ordered_.end()).size() == corners_.size();
  }

  /// The corner at the other end of the edge that leaves a base.
  int above(const std::vector<int>& base, std::size_t k) const {
    for (const Face& face : faces_) {
      const std::size_t count = face.corners.size();
      for (std::size_t c = 0; c < count; ++c) {
        const int a = face.corners[c], b = face.corners[(c + 1) % count];
        if (a == base[k] && std::ranges::find(base, b) == base.end()) return b;
        if (b == base[k] && std::ranges::find(base, a) == base.end()) return a;
      }
    }
    return base[k];
  }

  std::vector<std::vector<int>> faces_of(const std::vector<int>& nodes) const {
    std::vector<std::vector<int>> faces;
    for (const Face& face : faces_) {
      std::vector<int>& own = faces.emplace_back();
      for (const std::vector<int>* part : {&face.corners, &face.middles})
        for (const int node : *part)
          own.push_back(static_cast<int>(std::ranges::find(nodes, node) - nodes.begin()));
    }
    return faces;
  }

  const AbaqusElement& whole_;
  const std::vector<int>& alike_;
  std::vector<Face> faces_;
  std::set<int> corners_;
  std::map<Pair, int> middle_;  // of edges
  std::vector<int> ordered_;    // corners
};

}  // namespace

std::optional<CollapsedElement> collapsed(const AbaqusElement& whole,
                                          const std::vector<int>& alike) {
  return Collapse(whole, alike).run();
}

}  // namespace abut
