#include "coordinator/external_verb.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.hpp"

namespace abut {

std::string program_folder() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::string() : self.parent_path().string() + '/';
}

void offer_python_package() {
  std::error_code error;
  const std::filesystem::path package =
      std::filesystem::weakly_canonical(program_folder() + "../share/abut/python", error);
  if (error || !std::filesystem::is_directory(package, error)) return;
  // Behind what the user names: a package of somebody else is theirs to choose.
  const char* named = std::getenv("PYTHONPATH");
  const bool several = named != nullptr && *named != '\0';
  setenv("PYTHONPATH", ((several ? std::string(named) + ':' : "") + package.string()).c_str(), 1);
}

void become_external_verb(const std::string& verb, const std::vector<std::string>& arguments) {
  const std::string program = "abut-" + verb;
  std::vector<std::string> texts{program};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);

  // A verb with a slash would name a program anywhere, which is not what "beside" means.
  if (verb.find('/') == std::string::npos) {
    execv((program_folder() + program).c_str(), pointers.data());
    if (errno == ENOENT) execvp(program.c_str(), pointers.data());
  }
  const bool absent = verb.find('/') != std::string::npos || errno == ENOENT;
  throw InputError(
      absent ? fmt::format("there is no verb {}, and no program {} beside abut or on PATH", verb,
                           program)
             : fmt::format("{} cannot be started: {}", program, std::strerror(errno)),
      "", "The verbs are listed by abut --help.");
}

}  // namespace abut
