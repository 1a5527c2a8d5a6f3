#include "messaging/key_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <zmq.h>

#include "base/error.hpp"

namespace abut {

namespace {

constexpr const char* coordinator = "coordinator";
constexpr std::size_t key_length = 40;       // in Z85
constexpr std::size_t longest_file = 4'096;  // [B]
constexpr mode_t of_others = 077, written_by_others = 022;

/// Closes what it holds.
struct Descriptor {
  explicit Descriptor(int number) : value(number) {}
  ~Descriptor() {
    if (value >= 0) close(value);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value;
};

std::string public_file(const std::string& directory, const std::string& name) {
  return directory + "/" + name + ".key";
}
std::string secret_file(const std::string& directory, const std::string& name) {
  return directory + "/" + name + ".key_secret";
}

/// Who may change a public key lets in whom he likes; who reads a secret one is its body.
void require_closed(const struct stat& file, const std::string& path, bool secret) {
  const mode_t refused = secret ? of_others : written_by_others;
  if (file.st_uid != geteuid() && file.st_uid != 0)
    throw InputError("belongs to another user", path,
                     fmt::format("Make it this user's: chown {} {}", geteuid(), path));
  if ((file.st_mode & refused) == 0) return;
  throw InputError(fmt::format("may be {} by other users: its permissions are {:03o}",
                               secret ? "read or written" : "written", file.st_mode & 0777),
                   path, fmt::format("Close it: chmod {} {}", secret ? "go-rwx" : "go-w", path));
}

/// The whole text. Throws InputError.
std::string read_closed(const std::string& directory, const std::string& path, bool secret) {
  struct stat about {};
  const Descriptor folder(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.value < 0 || fstat(folder.value, &about) != 0)
    throw InputError(fmt::format("cannot be read: {}", std::strerror(errno)), directory,
                     fmt::format("Make keys: abut keygen {} BODY ...", directory));
  require_closed(about, directory, false);
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.value < 0 || fstat(file.value, &about) != 0)
    throw InputError(fmt::format("cannot be read: {}", std::strerror(errno)), path,
                     fmt::format("Make keys with abut keygen {} BODY ..., and copy this file from "
                                 "where they were made.",
                                 directory));
  if (!S_ISREG(about.st_mode))
    throw InputError("is no file", path, "Give a directory that abut keygen has made.");
  require_closed(about, path, secret);
  std::string text(longest_file, '\0');
  const ssize_t size = ::read(file.value, text.data(), text.size());
  text.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
  return text;
}

/// The value of a line `name = "value"`, which must be a key.
std::string find_key(const std::string& text, std::string_view name, const std::string& path) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.starts_with(name)) continue;
    const std::size_t open = line.find('"'), close = line.rfind('"');
    std::array<std::uint8_t, 32> bytes{};
    if (open == line.npos || close != open + 1 + key_length) break;
    std::string key(line.substr(open + 1, key_length));
    if (zmq_z85_decode(bytes.data(), key.c_str()) == nullptr) break;
    return key;
  }
  throw InputError(fmt::format("has no {}", name), path,
                   "Give a file that abut keygen has written, as it was written.");
}

std::string read_public(const std::string& directory, const std::string& name) {
  const std::string path = public_file(directory, name);
  return find_key(read_closed(directory, path, false), "public-key", path);
}

KeyPair read_pair(const std::string& directory, const std::string& name) {
  const std::string path = secret_file(directory, name);
  const std::string text = read_closed(directory, path, true);
  KeyPair pair{find_key(text, "public-key", path), find_key(text, "secret-key", path)};
  std::array<char, key_length + 1> derived{};
  if (zmq_curve_public(derived.data(), pair.secret_key.c_str()) == 0 &&
      pair.public_key == derived.data())
    return pair;
  throw InputError("holds a public key that does not belong to its secret one", path,
                   "Give a file that abut keygen has written, as it was written.");
}

/// What is there stays as it is.
void write_new(const std::string& path, const std::string& text, mode_t mode) {
  const Descriptor file(
      open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
  if (file.value < 0 && errno == EEXIST)
    throw InputError("is there already", path, "Remove it first if nobody uses it any more.");
  const bool whole =
      file.value >= 0 && fchmod(file.value, mode) == 0 &&
      write(file.value, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      fsync(file.value) == 0;
  if (whole) return;
  const std::string why = std::strerror(errno);
  if (file.value >= 0) unlink(path.c_str());
  throw RunError(fmt::format("cannot be written: {}", why), path,
                 "Give a directory that can be written to.");
}

void write_pair(const std::string& directory, const std::string& name,
                std::vector<std::string>& written) {
  std::array<char, key_length + 1> open{}, secret{};
  if (zmq_curve_keypair(open.data(), secret.data()) != 0)
    throw RunError("no keys can be drawn", directory, "install a libzmq that has CURVE");
  const std::string head = fmt::format("#   Key of {} for abut, drawn by libzmq.\n", name);
  const std::string shown = fmt::format("    public-key = \"{}\"\n", open.data());
  const std::string hidden = fmt::format("    secret-key = \"{}\"\n", secret.data());
  write_new(secret_file(directory, name),
            head + "#   Secret: for this user alone.\ncurve\n" + shown + hidden, 0600);
  written.push_back(secret_file(directory, name));
  write_new(public_file(directory, name), head + "curve\n" + shown, 0644);
  written.push_back(public_file(directory, name));
}

bool is_there(const std::string& path) {
  struct stat about {};
  return lstat(path.c_str(), &about) == 0;
}

void require_body_name(const std::string& name) {
  constexpr std::string_view allowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  if (!name.empty() && name.find_first_not_of(allowed) == name.npos && name != coordinator) return;
  throw InputError(fmt::format("'{}' can be no body with a key", name), "",
                   "Use letters, digits, _ and - alone; coordinator is the name of the other end.");
}

}  // namespace

void require_curve() {
  if (zmq_has("curve") == 1) return;
  throw InputError("keys cannot be used: libzmq was built without CURVE", "",
                   "Install a libzmq with CURVE, as Debian's libzmq5 is.");
}

std::vector<std::string> write_keys(const std::string& directory,
                                    std::span<const std::string> bodies) {
  require_curve();
  std::vector<std::string> names(bodies.begin(), bodies.end());
  for (const std::string& name : names) require_body_name(name);
  const bool known = is_there(secret_file(directory, coordinator));
  if (!known || names.empty()) names.insert(names.begin(), coordinator);
  for (const std::string& name : names)  // all or none
    for (const std::string& path : {secret_file(directory, name), public_file(directory, name)})
      if (is_there(path))
        throw InputError("is there already", path, "Remove it first if nobody uses it any more.");
  if (mkdir(directory.c_str(), 0700) != 0 && errno != EEXIST)
    throw RunError(fmt::format("cannot be made: {}", std::strerror(errno)), directory,
                   "Give a directory that can be made.");
  std::vector<std::string> written;
  for (const std::string& name : names) write_pair(directory, name, written);
  return written;
}

CoordinatorKeys read_coordinator_keys(const std::string& directory,
                                      std::span<const std::string> bodies) {
  require_curve();
  CoordinatorKeys keys{read_pair(directory, coordinator), {}};
  for (const std::string& body : bodies) {
    require_body_name(body);
    const std::string key = read_public(directory, body);
    const auto [entry, fresh] = keys.bodies.emplace(key, body);
    if (fresh && key != keys.own.public_key) continue;
    throw InputError(
        fmt::format("holds the key of {} as well", fresh ? coordinator : entry->second),
        public_file(directory, body), "Give every body a key of its own: abut keygen.");
  }
  return keys;
}

BodyKeys read_body_keys(const std::string& directory, const std::string& body) {
  require_curve();
  require_body_name(body);
  return {read_pair(directory, body), read_public(directory, coordinator)};
}

}  // namespace abut
