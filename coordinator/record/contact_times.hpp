#pragma once

#include "base/archive.hpp"

namespace abut {

/// What closes again within so many element transits of a release has not parted: neither is
/// resolved by the mesh.
inline constexpr double transits_of_one_contact = 5.0;

/// When an interface was closed, from the events of a run alone: windows have no part in it. A
/// release after which it closes again in less than `together` is none, and the contact goes on.
class ContactTimes {
 public:
  /// `together` [s]; 0: every release counts.
  explicit ContactTimes(double together) : together_(together) {}

  /// Tied from a time on: closed, but never touched.
  void join(double time);
  void close(double time);
  void open(double time);

  int count() const { return count_; }        // contacts
  int closings() const { return closings_; }  // more than contacts is chatter
  bool is_open() const { return !closed_; }
  double begin() const { return begin_; }  // [s] of the first contact
  double end() const { return end_; }      // [s] last release
  /// Whether closing at a time would go on with the last contact.
  bool goes_on(double time) const { return count_ > 0 && time - end_ < together_; }
  /// [s] from the begins of all contacts, and of the tie, to their ends.
  double closed(double run_end) const;

  void state(Archive& archive);

 private:
  double together_;
  int count_ = 0, closings_ = 0;
  bool closed_ = false;
  double begin_ = 0.0, end_ = 0.0;
  double since_ = 0.0;     // [s] begin of the contact that has not ended
  double finished_ = 0.0;  // [s] of those that have
};

}  // namespace abut
