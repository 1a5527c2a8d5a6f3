#include "coordinator/record/force_filter.hpp"

#include "coordinator/record/channel_class_filter.hpp"
#include "coordinator/record/mean_filter.hpp"

namespace abut {

namespace {

struct Make {
  std::unique_ptr<ForceFilter> operator()(const MeanForceSpec& spec) const {
    return std::make_unique<MeanFilter>(spec.time);
  }
  std::unique_ptr<ForceFilter> operator()(const ChannelClassSpec& spec) const {
    return std::make_unique<ChannelClassFilter>(spec.channel_class);
  }
};

}  // namespace

std::unique_ptr<ForceFilter> make_force_filter(const ForceFilterSpec& spec) {
  return std::visit(Make(), spec);
}

}  // namespace abut
