#pragma once

namespace abut {

/// From here on a program whose memory is used up where no exception may leave (a destructor that
/// allocates, as nlohmann's values do) says so and ends with exit code 3, as elsewhere.
/// `program`: begins the message; lives as long as the program.
void end_in_words_without_memory(const char* program);

}  // namespace abut
