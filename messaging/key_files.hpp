#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace abut {

// Keys of CURVE, the encryption of ZeroMQ, as files of a directory: NAME.key is public,
// NAME.key_secret is not; NAME is a body, or the coordinator. Their form is that of CZMQ and pyzmq.

struct KeyPair {
  std::string public_key, secret_key;  // Z85, 40 characters each
};

/// What a coordinator needs.
struct CoordinatorKeys {
  KeyPair own;
  std::map<std::string, std::string> bodies;  // names, by public key
};

/// What a body needs.
struct BodyKeys {
  KeyPair own;
  std::string coordinator;  // public key
};

/// What libzmq was built with: without CURVE there are no keys. Throws InputError.
void require_curve();

/// A pair for each of the bodies, and one for the coordinator unless it is there; answers the files
/// that were written, secret ones for this user alone. Throws InputError where a file is in the
/// way, RunError where none can be written.
std::vector<std::string> write_keys(const std::string& directory,
                                    std::span<const std::string> bodies);

/// Of these bodies. Throws InputError where a file is missing, is no key, may be read (a secret
/// one) or written by others, or two have the same key.
CoordinatorKeys read_coordinator_keys(const std::string& directory,
                                      std::span<const std::string> bodies);
/// Throws as above.
BodyKeys read_body_keys(const std::string& directory, const std::string& body);

}  // namespace abut
