#include "messaging/zmq_group.hpp"

#include <utility>

namespace abut {

struct ZmqGroup::Member : Channel {
  Member(ZmqDealer& its, std::string own_name) : dealer(its), name(std::move(own_name)) {}
  bool send(Bytes frame) override { return dealer.send_of(name, frame); }
  bool send(Bytes frame, std::shared_ptr<const void> owner) override {
    return dealer.send_of(name, frame, std::move(owner));
  }
  std::optional<Bytes> receive(Milliseconds) override {
    return std::exchange(received, std::nullopt);
  }

  ZmqDealer& dealer;
  std::string name;
  std::optional<Bytes> received;  // in the dealer's memory
};

ZmqGroup::ZmqGroup(ZmqDealer& dealer, const std::vector<std::string>& bodies) : dealer_(dealer) {
  for (const std::string& body : bodies) {
    numbers_.emplace(body, members_.size());
    members_.push_back(std::make_unique<Member>(dealer, body));
  }
}

ZmqGroup::~ZmqGroup() = default;

Channel& ZmqGroup::channel(std::size_t body) { return *members_.at(body); }

std::optional<std::size_t> ZmqGroup::wait(Milliseconds time) {
  const std::optional<Bytes> frame = dealer_.receive(time);
  if (!frame) return std::nullopt;
  const auto found = numbers_.find(dealer_.addressee());
  if (found == numbers_.end()) return std::nullopt;  // of nobody here
  members_[found->second]->received = frame;
  return found->second;
}

}  // namespace abut
