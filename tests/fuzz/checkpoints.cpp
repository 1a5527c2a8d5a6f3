// Files of checkpoints. The sum that damage is found by is made to fit: somebody who means harm
// would do that as well. The input is what follows it.
#include "base/archive.hpp"
#include "coordinator/record/checkpoint_file.hpp"
#include "tests/fuzz/hostile_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace abut;
  const fuzz::Input input = fuzz::input_of(data, size);
  const std::uint64_t sum = hash_bytes(input);
  std::string file = "abut checkpoint, form 1\n";
  file.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  file += fuzz::text_of(input);
  fuzz::read_or_refuse([&file] { parse_checkpoint(file, "checkpoint.abut"); });
  fuzz::read_or_refuse([&input] { parse_checkpoint(fuzz::text_of(input), "checkpoint.abut"); });
  return 0;
}
