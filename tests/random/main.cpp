// abut_fuzz: random scenes, and what must hold for every one of them (docs/ROBUSTNESS.md).

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "tests/random/random_scene.hpp"
#include "tests/random/verdict.hpp"

namespace abut {

namespace {

constexpr const char* usage =
    "usage: abut_fuzz [--keep DIR] [--seconds S] [--quiet] [--table] FIRST..LAST | FIRST | LIST\n"
    "  FIRST..LAST  random scenes of these seeds, a line each; exit 1 when one is not as it "
    "should be\n"
    "  LIST         a file of seeds, one or FIRST..LAST a line; `open` before it: known to fail\n"
    "  --seconds S  seeds from the first one on until so much time is over\n"
    "  --keep DIR   scenes that fail are written to DIR/SEED, to be run by abut run\n"
    "  --keep-all   with --keep: all scenes\n"
    "  --table      a table of what was seen at the end, in Markdown\n";

struct Options {
  std::string keep;
  double seconds = 0.0;
  bool quiet = false, table = false, all = false;
  std::string what;
};

/// Seeds, and which are known to fail.
struct Seeds {
  std::vector<std::uint64_t> all;
  std::vector<std::uint64_t> open;
};

void add(Seeds& seeds, const std::string& word, bool open) {
  const std::size_t dots = word.find("..");
  const std::uint64_t first = std::stoull(word);
  const std::uint64_t last = dots == std::string::npos ? first : std::stoull(word.substr(dots + 2));
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    seeds.all.push_back(seed);
    if (open) seeds.open.push_back(seed);
  }
}

Seeds seeds_of(const Options& options) {
  Seeds seeds;
  if (!std::filesystem::exists(options.what)) {
    add(seeds, options.what, false);
    return seeds;
  }
  std::ifstream file(options.what);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    if (!(words >> word)) continue;
    const bool open = word == "open";
    if (open) words >> word;
    add(seeds, word, open);
  }
  return seeds;
}

std::optional<Options> read(int count, char** words) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--quiet") {
      options.quiet = true;
    } else if (word == "--table") {
      options.table = true;
    } else if (word == "--keep-all") {
      options.all = true;
    } else if (word == "--keep" && i + 1 < count) {
      options.keep = words[++i];
    } else if (word == "--seconds" && i + 1 < count) {
      options.seconds = std::atof(words[++i]);
    } else if (!word.starts_with("-") && options.what.empty()) {
      options.what = word;
    } else {
      return std::nullopt;
    }
  }
  if (options.what.empty()) return std::nullopt;
  return options;
}

void keep(const Options& options, const RandomScene& scene, const Verdict& verdict) {
  if (options.keep.empty() || (verdict.trouble.empty() && !options.all)) return;
  const std::filesystem::path folder =
      std::filesystem::path(options.keep) / std::to_string(scene.seed);
  std::filesystem::create_directories(folder);
  scene.write(folder, verdict.view);
}

int run(const Options& options) {
  Seeds seeds = seeds_of(options);
  const std::string pattern = (std::filesystem::temp_directory_path() / "abut_fuzz_XXXXXX");
  std::string folder = pattern;
  if (mkdtemp(folder.data()) == nullptr) return 2;
  Table table;
  int failed = 0;
  const double begin = wall_seconds();
  for (std::size_t k = 0; k < seeds.all.size(); ++k) {
    const std::uint64_t seed = seeds.all[k];
    const RandomScene scene = scene_of(seed);
    const Verdict verdict = judge(scene, folder);
    const bool open = std::ranges::find(seeds.open, seed) != seeds.open.end();
    table.add(scene, verdict);
    if (!verdict.trouble.empty() && !open) ++failed;
    if (!options.quiet || !verdict.trouble.empty() || open) {
      const char* const said = open ? (verdict.trouble.empty() ? "mended " : "open   ")
                                    : (verdict.trouble.empty() ? "ok     " : "FAILS  ");
      fmt::print("{}{}\n", said, line_of(scene, verdict));
      std::fflush(stdout);
    }
    keep(options, scene, verdict);
    if (options.seconds > 0.0) {
      if (wall_seconds() - begin > options.seconds) break;
      seeds.all.push_back(seed + 1);
    }
  }
  std::filesystem::remove_all(folder);
  if (options.table) fmt::print("{}", table.text());
  fmt::print("{}\n", table.sentence());
  return failed > 0 ? 1 : 0;
}

}  // namespace
}  // namespace abut

int main(int count, char** words) {
  const std::optional<abut::Options> options = abut::read(count, words);
  if (!options) {
    fmt::print(stderr, "{}", abut::usage);
    return 2;
  }
  return abut::run(*options);
}
