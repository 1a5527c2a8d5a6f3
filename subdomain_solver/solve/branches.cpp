#include "subdomain_solver/solve/branches.hpp"

#include <algorithm>

#include "base/index.hpp"

namespace abut {

namespace {

/// Numbers of a factor from which threads are worth their waking: some milliseconds of memory.
constexpr std::size_t least_values = std::size_t{1} << 22;
/// Part of a factor that a branch has at most: enough branches for a few threads, and few rests
/// that wait at once.
constexpr std::size_t branch_share = 8;

struct Subtree {
  std::size_t values = 0, first = 0;  // numbers of the factor; its first front
  int parent = -1;
};

std::vector<Subtree> find_subtrees(const Fronts& fronts) {
  std::vector<Subtree> out(fronts.list.size());
  std::vector<std::size_t> waiting;
  for (std::size_t f = 0; f < out.size(); ++f) {
    const Front& front = fronts.list[f];
    out[f].values = index(front.rows) * index(front.columns);
    out[f].first = f;
    for (int child = 0; child < front.children; ++child) {
      Subtree& below = out[waiting.back()];
      waiting.pop_back();
      below.parent = static_cast<int>(f);
      out[f].values += below.values;
      out[f].first = below.first;
    }
    if (front.rest() > 0) waiting.push_back(f);
  }
  return out;
}

void count_rows(const Fronts& fronts, const Branch& branch, std::vector<int>& rows) {
  const Front& root = fronts.list[branch.end - 1];
  const auto left = fronts.rows.begin() + static_cast<std::ptrdiff_t>(root.list) + root.columns;
  for (std::size_t f = branch.first; f < branch.end; ++f) {
    const Front& front = fronts.list[f];
    for (std::size_t k = front.list; k < front.list + index(front.rows); ++k) {
      const int own = fronts.rows[k] - branch.first_column;
      rows[k] = own < branch.columns
                    ? own
                    : branch.columns +
                          static_cast<int>(
                              std::lower_bound(left, left + root.rest(), fronts.rows[k]) - left);
    }
  }
}

std::size_t squared_rest(const Front& front) { return index(front.rest()) * index(front.rest()); }

/// Most numbers that wait while fronts are eliminated one after the other; those of branches wait
/// elsewhere where there are some.
template <class FrontOf>
std::size_t most_waiting(std::size_t count, const FrontOf& front_of) {
  std::vector<std::size_t> waiting;
  std::size_t now = 0, most = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto [front, whole] = front_of(k);
    for (int child = 0; !whole && child < front->children; ++child) {
      now -= waiting.back();
      waiting.pop_back();
    }
    if (front->rest() == 0) continue;
    waiting.push_back(whole ? 0 : squared_rest(*front));
    now += waiting.back();
    most = std::max(most, now);
  }
  return most;
}

void find_stacks(const Fronts& fronts, Branches& out) {
  struct Step {
    const Front* front;
    bool whole;  // a branch that is done
  };
  std::vector<Step> top;
  std::size_t f = 0;
  for (const Branch& branch : out.list) {
    for (; f < branch.first; ++f) top.push_back({&fronts.list[f], false});
    top.push_back({&fronts.list[branch.end - 1], true});
    f = branch.end;
    out.stack = std::max(out.stack, most_waiting(branch.end - branch.first, [&](std::size_t k) {
                           return Step{&fronts.list[branch.first + k], false};
                         }));
  }
  for (; f < fronts.list.size(); ++f) top.push_back({&fronts.list[f], false});
  out.top_stack = most_waiting(top.size(), [&top](std::size_t k) { return top[k]; });
}

}  // namespace

Branches find_branches(const Fronts& fronts) {
  Branches out;
  out.rows = fronts.rows;
  const std::size_t most = fronts.values < least_values ? 0 : fronts.values / branch_share;
  const std::vector<Subtree> subtrees = find_subtrees(fronts);
  std::size_t next = 0;  // front that nobody has yet
  const auto leave = [&](std::size_t end) {
    for (; next < end; ++next) out.others.push_back(&fronts.list[next]);
  };
  for (std::size_t f = 0; f < subtrees.size(); ++f) {
    const int parent = subtrees[f].parent;
    if (subtrees[f].values > most || (parent >= 0 && subtrees[index(parent)].values <= most))
      continue;
    leave(subtrees[f].first);
    next = f + 1;
    const Front& root = fronts.list[f];
    Branch branch{subtrees[f].first, f + 1,     fronts.list[subtrees[f].first].first, 0,
                  root.rest(),       out.places};
    branch.columns = root.first + root.columns - branch.first_column;
    out.places += index(branch.size());
    count_rows(fronts, branch, out.rows);
    out.list.push_back(branch);
  }
  leave(subtrees.size());
  find_stacks(fronts, out);
  return out;
}

}  // namespace abut
