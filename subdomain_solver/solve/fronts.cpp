#include "subdomain_solver/solve/fronts.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include <metis.h>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/solve/front_elimination.hpp"

namespace abut {

namespace {

/// Coordinates side by side whose columns have the same pattern, and who neighbours whom.
struct Groups {
  std::vector<int> first;    // (groups + 1) coordinate
  std::vector<idx_t> begin;  // (groups + 1) in `neighbours`
  std::vector<idx_t> neighbours;
  int count() const { return static_cast<int>(first.size()) - 1; }
  int size(int group) const { return first[index(group) + 1] - first[group]; }
  std::span<const idx_t> of(int group) const {
    return {neighbours.data() + begin[group], index(begin[index(group) + 1] - begin[group])};
  }
};

std::span<const int> pattern(const SparseMatrix& matrix, int column) {
  const int begin = matrix.outerIndexPtr()[column], end = matrix.outerIndexPtr()[column + 1];
  return {matrix.innerIndexPtr() + begin, index(end - begin)};
}

Groups find_groups(const SparseMatrix& matrix) {
  const int n = static_cast<int>(matrix.cols());
  Groups out;
  std::vector<int> group_of(index(n));
  for (int j = 0; j < n; ++j) {
    if (j == 0 || !std::ranges::equal(pattern(matrix, j), pattern(matrix, j - 1)))
      out.first.push_back(j);
    group_of[j] = static_cast<int>(out.first.size()) - 1;
  }
  out.first.push_back(n);
  out.begin.push_back(0);
  for (int g = 0; g < out.count(); ++g) {
    int last = -1;
    for (const int row : pattern(matrix, out.first[g])) {
      const int other = group_of[row];
      if (other != g && other != last) out.neighbours.push_back(other);
      last = other;
    }
    out.begin.push_back(static_cast<idx_t>(out.neighbours.size()));
  }
  return out;
}

/// The groups in an order of nested dissection.
std::vector<int> dissect(Groups& groups) {
  std::vector<int> order(index(groups.count()));
  std::iota(order.begin(), order.end(), 0);
  if (groups.neighbours.empty()) return order;
  idx_t count = groups.count();
  std::vector<idx_t> weights(index(count)), at(index(count)), place(index(count));
  for (int g = 0; g < count; ++g) weights[g] = groups.size(g);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  const int end = METIS_NodeND(&count, groups.begin.data(), groups.neighbours.data(),
                               weights.data(), options, at.data(), place.data());
  ABUT_ASSERT(end == METIS_OK);
  std::ranges::copy(at, order.begin());
  return order;
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  return place;
}

/// The elimination tree of an order: parents, or -1 (J. W. H. Liu, 1990).
std::vector<int> find_parents(const Groups& groups, const std::vector<int>& order) {
  const std::vector<int> place = inverse(order);
  std::vector<int> parent(order.size(), -1), root(order.size(), -1);
  for (int p = 0; p < groups.count(); ++p) {
    for (const idx_t neighbour : groups.of(order[p])) {
      int at = place[neighbour];
      if (at >= p) continue;
      while (root[at] >= 0 && root[at] != p) at = std::exchange(root[at], p);
      if (root[at] >= 0) continue;
      root[at] = p;
      parent[at] = p;
    }
  }
  return parent;
}

/// Makes the order one in which what is below a vertex stands right before it.
void make_postorder(const std::vector<int>& parent, std::vector<int>& order) {
  const int n = static_cast<int>(order.size());
  std::vector<int> child(order.size(), -1), next(order.size(), -1), stack, out;
  for (int v = n - 1; v >= 0; --v) {
    if (parent[v] < 0) continue;
    next[v] = child[parent[v]];
    child[parent[v]] = v;
  }
  for (int root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int top = stack.back();
      if (const int below = child[top]; below >= 0) {
        child[top] = next[below];
        stack.push_back(below);
      } else {
        out.push_back(order[top]);
        stack.pop_back();
      }
    }
  }
  order = std::move(out);
}

/// A front of groups: its columns and its rest, by places of the groups in the order.
struct GroupFront {
  int first = 0, end = 0;         // columns
  std::vector<int> rest;          // ascending
  double wide = 0.0, left = 0.0;  // coordinates of the columns, of the rest
  double zeros = 0.0;             // entries that are stored and need not be
  double entries() const { return wide * (0.5 * wide + left); }
};

class FrontFinder {
 public:
  FrontFinder(const Groups& groups, const std::vector<int>& order)
      : groups_(groups), order_(order), place_(inverse(order)), seen_(order.size(), -1) {}

  std::vector<GroupFront> find() {
    for (int p = 0; p < groups_.count(); ++p) add(p);
    std::vector<GroupFront> joined;
    for (GroupFront& front : fronts_) {
      while (!joined.empty() && worth_joining(joined.back(), front)) {
        join(joined.back(), front);
        joined.pop_back();
      }
      joined.push_back(std::move(front));
    }
    return joined;
  }

 private:
  double weight(int place) const { return groups_.size(order_[place]); }

  /// The rest of a column: its own rows below and those that its children leave. Children are the
  /// fronts whose rest begins with it.
  void add(int p) {
    std::vector<int> rest;
    seen_[p] = p;
    const auto take = [&](int row) {
      if (row <= p || seen_[row] == p) return;
      seen_[row] = p;
      rest.push_back(row);
    };
    for (const idx_t other : groups_.of(order_[p])) take(place_[other]);
    for (const std::size_t child : children_of(p))
      for (const int row : fronts_[child].rest) take(row);
    std::ranges::sort(rest);
    GroupFront* last = fronts_.empty() ? nullptr : &fronts_.back();
    if (last != nullptr && last->end == p && !last->rest.empty() && last->rest.front() == p &&
        last->rest.size() == rest.size() + 1) {
      last->end = p + 1;
      last->wide += weight(p);
      last->left -= weight(p);
      last->rest = std::move(rest);
      wait_for(fronts_.size() - 1);
      return;
    }
    GroupFront front{p, p + 1, std::move(rest), weight(p)};
    for (const int row : front.rest) front.left += weight(row);
    fronts_.push_back(std::move(front));
    wait_for(fronts_.size() - 1);
  }

  /// Fronts that wait for their parent's column stand last, as the order is a postorder.
  std::vector<std::size_t> children_of(int p) {
    std::vector<std::size_t> out;
    while (!waiting_.empty() && fronts_[waiting_.back()].rest.front() == p) {
      out.push_back(waiting_.back());
      waiting_.pop_back();
    }
    return out;
  }
  void wait_for(std::size_t front) {
    if (!fronts_[front].rest.empty()) waiting_.push_back(front);
  }

  /// Small fronts cost more than zeros do (C. Ashcraft and R. Grimes, 1989).
  static bool worth_joining(const GroupFront& child, const GroupFront& parent) {
    if (child.end != parent.first || child.rest.empty() || child.rest.front() >= parent.end)
      return false;
    const double wide = child.wide + parent.wide;
    const double more = child.wide * (parent.wide + parent.left - child.left);
    const double zeros = child.zeros + parent.zeros + more;
    const double share = zeros / (wide * (0.5 * wide + parent.left));
    if (wide <= 8.0) return true;
    return share < (wide <= 24.0 ? 0.5 : wide <= 64.0 ? 0.15 : 0.05);
  }
  static void join(const GroupFront& child, GroupFront& parent) {
    parent.zeros += child.zeros + child.wide * (parent.wide + parent.left - child.left);
    parent.wide += child.wide;
    parent.first = child.first;
  }

  const Groups& groups_;
  const std::vector<int>& order_;
  std::vector<int> place_;
  std::vector<int> seen_;  // by which column
  std::vector<GroupFront> fronts_;
  std::vector<std::size_t> waiting_;
};

/// Of groups: of coordinates.
void expand(const Groups& groups, const std::vector<int>& order,
            const std::vector<GroupFront>& fronts, Fronts& out) {
  std::vector<int> first;  // place of each group's first coordinate
  for (const int group : order) {
    first.push_back(static_cast<int>(out.order.size()));
    for (int k = groups.first[group]; k < groups.first[index(group) + 1]; ++k)
      out.order.push_back(k);
  }
  first.push_back(static_cast<int>(out.order.size()));
  const auto append = [&](int place) {
    for (int k = first[place]; k < first[index(place) + 1]; ++k) out.rows.push_back(k);
  };
  for (const GroupFront& from : fronts) {
    Front front;
    front.first = first[from.first];
    front.columns = first[from.end] - front.first;
    front.list = out.rows.size();
    front.values = out.values;
    for (int place = from.first; place < from.end; ++place) append(place);
    for (const int place : from.rest) append(place);
    front.rows = static_cast<int>(out.rows.size() - front.list);
    out.values += index(front.rows) * index(front.columns);
    out.list.push_back(front);
  }
}

/// Where the rows that a front leaves are among its parent's.
void find_parents(Fronts& out) {
  out.in_parent.assign(out.rows.size(), -1);
  std::vector<int> front_of(out.order.size());
  for (std::size_t f = 0; f < out.list.size(); ++f)
    std::fill_n(front_of.begin() + out.list[f].first, out.list[f].columns, static_cast<int>(f));
  for (Front& front : out.list) {
    if (front.rest() == 0) continue;
    const int* row = out.rows.data() + front.list;
    Front& parent = out.list[index(front_of[row[front.columns]])];
    ++parent.children;
    const int* rows = out.rows.data() + parent.list;
    int at = 0;
    for (int k = front.columns; k < front.rows; ++k) {
      while (rows[at] != row[k]) ++at;
      out.in_parent[front.list + index(k)] = at;
    }
  }
}

void find_sizes(Fronts& out) {
  std::vector<std::size_t> waiting;
  std::size_t now = 0;
  for (const Front& front : out.list) {
    for (int child = 0; child < front.children; ++child) {
      now -= waiting.back();
      waiting.pop_back();
    }
    const std::size_t rest = index(front.rest()) * index(front.rest());
    if (rest > 0) waiting.push_back(rest);
    now += rest;
    out.stack = std::max(out.stack, now);
    out.largest_rest = std::max(out.largest_rest, rest);
    out.space = std::max(out.space, elimination_space(index(front.rows), index(front.columns)));
    out.longest = std::max(out.longest, index(front.rows));
  }
}

}  // namespace

Fronts find_fronts(const SparseMatrix& matrix) {
  Fronts out;
  Groups groups = find_groups(matrix);
  std::vector<int> order = dissect(groups);
  make_postorder(find_parents(groups, order), order);
  expand(groups, order, FrontFinder(groups, order).find(), out);
  find_parents(out);
  find_sizes(out);
  return out;
}

}  // namespace abut
