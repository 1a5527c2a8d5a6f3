// Form of the file: a line that names it, the sum of what follows (8 bytes, XXH3), and the named
// fields of the checkpoint. Numbers are in the machine's own order of bytes, which the sum tells.
#include "coordinator/record/checkpoint_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/archive_lists.hpp"
#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/machine_memory.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view heading = "abut checkpoint, form 1\n";
constexpr const char* start_again = "Run the scene again.";

void rename_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error)
    throw RunError(fmt::format("cannot be renamed to {}: {}", to.string(), error.message()),
                   from.string(), "Check that nothing else uses the run's folder.");
}

/// A file that is being written, and goes away where it does not come to its name.
class NewFile {
 public:
  explicit NewFile(fs::path path) : path_(std::move(path)) {
    std::error_code ignored;
    fs::remove(path_, ignored);  // what a run that was killed has left
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("made");
  }
  ~NewFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!named_) unlink(path_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) fail("written");
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  void finish() {
    if (fsync(descriptor_) != 0) fail("written");
    if (close(std::exchange(descriptor_, -1)) != 0) fail("written");
  }
  /// Of a file that is finished, in the same folder.
  void name(const fs::path& path) {
    rename_file(path_, path);
    named_ = true;
  }

 private:
  [[noreturn]] void fail(const char* doing) const {
    throw RunError(fmt::format("cannot be {}: {}", doing, std::strerror(errno)), path_.string(),
                   "Check that the folder is writable and has space left. The checkpoint before "
                   "this one is still there");
  }
  fs::path path_;
  int descriptor_ = -1;
  bool named_ = false;
};

/// Names in a directory are on the disk as well.
void settle(const fs::path& directory) {
  const int descriptor = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);  // some file systems have no such thing; nothing better can be done there
  close(descriptor);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(fs::symlink_status(path, ignored));
}

std::string_view as_text(const std::uint64_t& sum) {
  return {reinterpret_cast<const char*>(&sum), sizeof sum};
}

}  // namespace

void Checkpoint::state(Archive& archive) {
  archive.field("version", version);
  archive.field("scene", scene);
  archive.field("time", time);
  archive.field("windows", windows);
  archive.field("stage_ends", stage_ends);
  archive.field("run", run);
  for (std::vector<Part>* parts : {&bodies, &records}) {
    list(archive, "parts", *parts, [](Archive& a, Part& part) {
      a.field("name", part.name);
      a.field("fingerprint", part.fingerprint);
      a.field("state", part.state);
    });
  }
}

const Checkpoint::Part* Checkpoint::record(std::string_view name) const {
  const auto found = std::ranges::find(records, name, &Part::name);
  return found == records.end() ? nullptr : &*found;
}

std::int64_t fingerprint(const Description& body) {
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, Archive::Form::bare);
  std::int64_t dofs = body.dofs;
  archive.field("dofs", dofs);
  std::string names;
  for (const std::string& name : body.columns) names += name + '\n';
  for (const Port& port : body.ports) {
    names += port.name + '\n';
    std::vector<double> points = port.geometry.points;
    archive.field("points", points);
  }
  archive.field("names", names);
  archive.finish();
  return static_cast<std::int64_t>(hash_bytes(bytes));
}

void write_checkpoint(const fs::path& directory, Checkpoint& checkpoint) {
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, Archive::Form::named);
  checkpoint.state(archive);
  archive.finish();
  const std::uint64_t sum = hash_bytes(bytes);
  const fs::path latest = directory / latest_checkpoint;
  NewFile file(directory / unfinished_checkpoint);
  file.write(heading);
  file.write(as_text(sum));
  file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  file.finish();
  if (is_file(latest)) rename_file(latest, directory / earlier_checkpoint);
  file.name(latest);
  settle(directory);
}

Checkpoint parse_checkpoint(std::string_view bytes, const std::string& path) {
  if (!bytes.starts_with(heading))
    throw InputError("is no checkpoint that this version can read", path, start_again);
  bytes.remove_prefix(heading.size());
  std::uint64_t sum = 0;
  if (bytes.size() < sizeof sum) throw InputError("is cut off", path, start_again);
  std::memcpy(&sum, bytes.data(), sizeof sum);
  bytes.remove_prefix(sizeof sum);
  const std::span<const std::byte> held = std::as_bytes(std::span<const char>(bytes));
  if (hash_bytes(held) != sum)
    throw InputError("is damaged: its sum is another", path, start_again);
  Checkpoint checkpoint;
  try {
    Archive archive = Archive::reader(held, Archive::Form::named);
    checkpoint.state(archive);
    archive.finish();
  } catch (const RunError& error) {
    throw InputError(error.what_is_wrong, path, start_again);
  }
  return checkpoint;
}

namespace {

Checkpoint read_file(const fs::path& path) {
  const std::size_t most = static_cast<std::size_t>(0.5 * machine_memory());
  return parse_checkpoint(read_input_file(path.string(), most, start_again), path.string());
}

}  // namespace

std::optional<Checkpoint> read_earlier_checkpoint(const fs::path& directory) {
  const fs::path path = directory / earlier_checkpoint;
  if (!is_file(path)) return std::nullopt;
  try {
    return read_file(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Checkpoint read_checkpoint(const fs::path& directory, std::vector<std::string>& warnings) {
  std::optional<InputError> wrong;
  for (const char* name : {latest_checkpoint, earlier_checkpoint}) {
    const fs::path path = directory / name;
    if (!is_file(path)) continue;
    try {
      Checkpoint checkpoint = read_file(path);
      if (wrong) warnings.push_back(fmt::format("{}; the one before it is used", wrong->what()));
      return checkpoint;
    } catch (const InputError& error) {
      if (!wrong) wrong = error;
    }
  }
  if (wrong) throw *wrong;
  throw InputError("holds no checkpoint", directory.string(),
                   "Give the directory of a run with output: {checkpoint: {windows: N}}, or one "
                   "that a signal has ended.");
}

}  // namespace abut
