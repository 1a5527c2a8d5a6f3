#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/subdomain.hpp"
#include "messaging/caller.hpp"
#include "messaging/codec.hpp"
#include "messaging/remote_passive.hpp"
#include "messaging/riding_flags.hpp"

namespace abut {

/// A Subdomain whose body is elsewhere. One request and one reply per advance; save and restore
/// ride on the request that follows them and never cost a message.
class RemoteSubdomain : public Subdomain {
 public:
  /// The caller must outlive this object.
  explicit RemoteSubdomain(Caller& caller) : caller_(caller) {}

  /// Sends the specification; several bodies can build themselves at the same time.
  void start_configure(const Specification& specification);
  /// Waits for the description. Throws the body's own InputError when the specification is wrong.
  void finish_configure();
  /// A round trip that does nothing.
  void ping();

  const Description& describe() const override { return description_; }
  void meet(const Meeting& meeting) override;
  void save() override { flags_.save(); }
  void restore() override { flags_.restore(); }
  void start(const Advance& request) override;
  [[nodiscard]] Outcome finish(Response& response) override;
  PortKernel probe(const Probing& asked) override;
  std::vector<std::byte> checkpoint() override;
  void resume(std::span<const std::byte> bytes) override;
  std::uint64_t state_hash() override;
  std::vector<double> measure() override;
  Grid grid() override;
  /// Asks for the grid first where that has not been done: the reply is held against it.
  std::vector<FieldValues> fields() override;
  PassiveForm* passive() override { return description_.can.passive ? &passive_ : nullptr; }

 private:
  void carry_flags();
  PortKernel probe_part(const Probing& probing);
  void meet_part(const Meeting& meeting, std::optional<int> first);

  Caller& caller_;
  Description description_;
  const Advance* asked_ = nullptr;  // between start() and finish()
  RidingFlags flags_;
  RemotePassive passive_{caller_, description_, flags_};
  struct GridSize {
    std::size_t nodes = 0, cells = 0;
  };
  std::optional<GridSize> grid_size_;  // once asked for
};

}  // namespace abut
