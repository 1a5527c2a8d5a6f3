#pragma once

#include <stdexcept>
#include <string>

namespace abut {

/// The user's kind of error: what is wrong, where, and what to do. Ends the program with exit
/// code 2. what() is one paragraph, "<where>: <what is wrong>. <remedy>".
class InputError : public std::runtime_error {
 public:
  InputError(std::string what_is_wrong, std::string where, std::string remedy);

  std::string what_is_wrong;  // a predicate without full stop: "must be positive, but is -1 m"
  std::string where;          // "file.yaml:12: bodies.left.material" or empty
  std::string remedy;         // a sentence: what to change
};

/// The world's kind of error: a lost peer, a deadline, a full disk. Ends the program with exit
/// code 3. what() reads as that of InputError.
class RunError : public std::runtime_error {
 public:
  RunError(std::string what_is_wrong, std::string where, std::string remedy);

  std::string what_is_wrong;
  std::string where;
  std::string remedy;
};

}  // namespace abut
