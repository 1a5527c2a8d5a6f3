#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/archive.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// A whole run between two windows.
struct Checkpoint {
  struct Part {
    std::string name;
    std::string state;             // bytes
    // Of a body: what must be the same when it resumes; 0: it is handed over to another one.
    std::int64_t fingerprint = 0;
  };
  std::string version;       // of the program that wrote it
  std::string scene;         // resolved: every value in use
  double time = 0.0;         // [s]
  std::int64_t windows = 0;  // accepted so far
  bool stage_ends = false;   // at the end of a stage that another one follows
  std::string run;           // Controller::save
  std::vector<Part> bodies;
  std::vector<Part> records;  // of observers, by Observer::kept_as

  void state(Archive& archive);
  const Part* record(std::string_view name) const;  // null: it was not kept
};

/// Of what a body tells of itself: its unknowns, the names of its columns, and where the points of
/// its ports are. Not of its mass, a sum that schemes round in their own ways.
std::int64_t fingerprint(const Description& body);

/// The latest checkpoint of a run and the one before it are kept in its directory.
inline constexpr const char* latest_checkpoint = "checkpoint.abut";
inline constexpr const char* earlier_checkpoint = "checkpoint.before.abut";
inline constexpr const char* unfinished_checkpoint = "checkpoint.abut.tmp";

/// Writes it as the latest of a run; it is on the disk when this returns, and at any instant until
/// then, whatever ends the program, the directory holds a whole one. Throws RunError.
void write_checkpoint(const std::filesystem::path& directory, Checkpoint& checkpoint);

/// The latest that is whole; what is wrong with a later one is added to `warnings`. Throws
/// InputError: there is none, or none that is whole or of this format.
Checkpoint read_checkpoint(const std::filesystem::path& directory,
                           std::vector<std::string>& warnings);

/// The one before the latest; nothing: it is not there, or not whole.
std::optional<Checkpoint> read_earlier_checkpoint(const std::filesystem::path& directory);

/// What a file holds. Throws InputError.
Checkpoint parse_checkpoint(std::string_view bytes, const std::string& path);

}  // namespace abut
