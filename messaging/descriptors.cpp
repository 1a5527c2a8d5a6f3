#include "messaging/descriptors.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "base/error.hpp"

namespace abut {

void require_descriptors(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  // Trying is the one way that counts what is open and what other limits there are.
  std::vector<int> tried;
  int error = 0;
  for (int i = 0; i < wanted && error == 0; ++i) {
    const int descriptor = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
      error = errno;
    } else {
      tried.push_back(descriptor);
    }
  }
  for (const int descriptor : tried) close(descriptor);
  if (error == 0) return;
  throw RunError(
      fmt::format("only {} of {} files and sockets more can be opened: {}", tried.size(), wanted,
                  std::strerror(error)),
      "messaging",
      "raise the limit of open files, for example: ulimit -n 1024");
}

}  // namespace abut
