#pragma once

#include <filesystem>
#include <string>

namespace abut {

/// Where the files of a run go when the command line does not say: runs/<scene name>.
std::filesystem::path default_run_directory(const std::string& scene_path);

/// The directory of one run, which no other run uses while this object lives. The lock is on the
/// directory itself and goes with the process, however that ends: nothing stale can be left.
/// Symbolic links in the directory are never followed, and nothing but what a run wrote is removed.
class RunDirectory {
 public:
  /// Makes the directory and its parents. Throws InputError when it holds a run already (unless
  /// `force`) or files of a run's names that are no run's, when another run uses it, or when it
  /// cannot be written; then nothing has been changed.
  RunDirectory(std::filesystem::path directory, bool force);
  /// That of a run which is to go on. Throws InputError when it holds none, or is in use.
  static RunDirectory of_run(std::filesystem::path directory);
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }
  bool has_checkpoint() const;
  /// Takes out the files of an earlier run, so that none is taken for the new one's. Throws
  /// InputError.
  void clear();
  /// Takes out what an earlier end of this run has left: summary, page, films, progress. Throws
  /// InputError.
  void go_on();
  /// Where the program's wall time is told; what an earlier program of this run told is taken out.
  /// Throws InputError.
  std::filesystem::path new_trace();
  /// The run never begins: takes the directory away again if it was made here and is empty.
  void abandon();

 private:
  void refuse_what_stays(bool force) const;
  void remove(const char* name);

  std::filesystem::path path_;
  int lock_ = -1;  // descriptor of the directory
  bool fresh_ = false;
};

}  // namespace abut
