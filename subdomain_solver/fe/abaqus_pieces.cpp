#include "subdomain_solver/fe/abaqus_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"

namespace abut {
namespace {

using Point = std::array<double, 3>;
using PlaceOfNode = std::unordered_map<std::int64_t, std::int32_t>;

/// Where an instance takes a point of its part: moved, then turned about its axis (Rodrigues).
Point placed(const AbaqusModel::Instance& instance, Point x) {
  for (std::size_t d = 0; d < 3; ++d) x[d] += instance.move[d];
  if (instance.degrees == 0.0) return x;
  Point axis{}, from{};
  double length = 0.0;
  for (std::size_t d = 0; d < 3; ++d) {
    axis[d] = instance.b[d] - instance.a[d];
    from[d] = x[d] - instance.a[d];
    length = std::hypot(length, axis[d]);
  }
  for (double& part : axis) part /= length;
  const double angle = instance.degrees * std::numbers::pi / 180.0;
  const double along = axis[0] * from[0] + axis[1] * from[1] + axis[2] * from[2];
  const Point across = {axis[1] * from[2] - axis[2] * from[1],
                        axis[2] * from[0] - axis[0] * from[2],
                        axis[0] * from[1] - axis[1] * from[0]};
  for (std::size_t d = 0; d < 3; ++d)
    x[d] = instance.a[d] + std::cos(angle) * from[d] + std::sin(angle) * across[d] +
           (1.0 - std::cos(angle)) * along * axis[d];
  return x;
}

/// Numbers of a range that there are; those that are named one by one and are not there go to
/// `missing`.
template <class Each, class Missing>
void each_of(const AbaqusModel::Picked& picked, const PlaceOfNode& places, Each each,
             Missing missing) {
  const auto there = [&](std::int64_t number) {
    return (number - picked.first) % picked.step == 0 && number >= picked.first &&
           number <= picked.last;
  };
  const auto count = static_cast<std::uint64_t>((picked.last - picked.first) / picked.step);
  if (picked.generated && count > places.size()) {  // a range may be far longer than the file
    for (const auto& [number, place] : places)
      if (there(number)) each(place);
    return;
  }
  for (std::uint64_t k = 0; k <= count; ++k) {
    const std::int64_t number = picked.first + static_cast<std::int64_t>(k) * picked.step;
    const auto found = places.find(number);
    if (found != places.end())
      each(found->second);
    else if (!picked.generated)
      missing(number);
  }
}

std::vector<std::int32_t> sorted(std::vector<std::int32_t> all) {
  keep_one_each(all);
  return all;
}

}  // namespace

AbaqusPieces::AbaqusPieces(const AbaqusModel& model, const AbaqusCursor& file) : file_(file) {
  add_piece(model.assembly, nullptr, "");
  for (const AbaqusModel::Instance& instance : model.instances)
    add_piece(model.parts[index(instance.part)], &instance, instance.name);
  if (!model.instances.empty()) return;
  for (const AbaqusModel::Scope& part : model.parts) add_piece(part, nullptr, part.name);
}

void AbaqusPieces::refuse(AbaqusLine line, const std::string& what,
                          const std::string& remedy) const {
  throw InputError(what, file_.where(line), remedy);
}

void AbaqusPieces::add_piece(const AbaqusModel::Scope& scope, const AbaqusModel::Instance* instance,
                             const std::string& name) {
  Piece& piece = pieces_.emplace_back();
  piece.scope = &scope;
  piece.name = name;
  piece.first_node = static_cast<std::int32_t>(numbers_.size());
  if (numbers_.size() + scope.numbers.size() > index(std::numeric_limits<std::int32_t>::max()))
    throw InputError("has too many nodes", file_.files().front(), "Make the mesh coarser.");
  for (std::size_t n = 0; n < scope.numbers.size(); ++n) {
    numbers_.push_back(static_cast<std::uint64_t>(scope.numbers[n]));
    Point x = {scope.points[3 * n], scope.points[3 * n + 1], scope.points[3 * n + 2]};
    if (instance != nullptr) x = placed(*instance, x);
    points_.insert(points_.end(), x.begin(), x.end());
  }
  for (const AbaqusModel::Elements& block : scope.elements) add_elements(piece, block);
}

void AbaqusPieces::add_elements(Piece& piece, const AbaqusModel::Elements& block) {
  const auto count = index(block.type->nodes);
  for (std::size_t e = 0; e < block.numbers.size(); ++e) {
    Element element = {block.type, block.name, block.numbers[e], block.lines[e], nodes_.size()};
    const auto text = [&] {
      return fmt::format("has element {} ({})", element.number, block.name);
    };
    if (!piece.element_of.try_emplace(element.number, static_cast<std::int32_t>(elements_.size()))
             .second)
      refuse(element.line, fmt::format("has element {} twice", element.number),
             "Take one of them out, or give it another number.");
    for (std::size_t a = 0; a < count; ++a) {
      const std::int64_t number = block.nodes[e * count + a];
      const auto found = piece.scope->place_of.find(number);
      if (found == piece.scope->place_of.end())
        refuse(element.line, fmt::format("{} with node {}, which is not there", text(), number),
               "Write the node, or correct the element.");
      nodes_.push_back(piece.first_node + found->second);
    }
    collapse(element);
    elements_.push_back(element);
  }
}

/// The last element, where nodes repeat in it: it becomes what it has collapsed to.
void AbaqusPieces::collapse(Element& element) {
  const auto own = std::span(nodes_).subspan(element.begin);
  std::vector<int> alike;
  for (const std::int32_t node : own)
    alike.push_back(static_cast<int>(std::ranges::find(own, node) - own.begin()));
  const auto repeats = [&alike](std::size_t a) { return index(alike[a]) != a; };
  std::size_t twice = 0;
  while (twice < alike.size() && !repeats(twice)) ++twice;
  if (twice == alike.size()) return;
  const auto [entry, fresh] = shapes_.try_emplace({element.type, alike});
  if (fresh) entry->second = collapsed(*element.type, alike);
  if (!entry->second)
    refuse(element.line,
           fmt::format("has element {} ({}) with node {} twice", element.number, element.name,
                       numbers_[index(own[twice])]),
           "A hexahedron may collapse to a prism (as 1,2,3,3,5,6,7,7), a pyramid (1,2,3,4,5,5,5,5) "
           "or a tetrahedron (1,2,3,3,5,5,5,5), a quadrilateral to a triangle; middle nodes of "
           "edges that have gone repeat their corner. Correct the element.");
  const CollapsedElement& shape = *entry->second;
  std::vector<std::int32_t> nodes;
  for (const int a : shape.nodes) nodes.push_back(own[index(a)]);
  nodes_.resize(element.begin);
  nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
  element.type = &shape.type;
  const DividedShape* divided = shape.type.divided;
  ++collapsed_to_[std::string(divided != nullptr ? divided->name : shape.type.type->name)];
}

std::vector<std::int32_t> AbaqusPieces::elements(std::size_t piece,
                                                 const std::vector<AbaqusModel::Picked>& picked,
                                                 const std::string& name) const {
  std::vector<std::int32_t> all;
  for (const AbaqusModel::Picked& one : picked) {
    const Piece& from = one.instance < 0 ? pieces_[piece] : pieces_[index(one.instance) + 1];
    each_of(
        one, from.element_of, [&all](std::int32_t place) { all.push_back(place); },
        [&](std::int64_t number) {
          refuse(one.line, fmt::format("has element {} in '{}', which is not there", number, name),
                 "Take it out, or write the element.");
        });
  }
  return sorted(std::move(all));
}

std::vector<std::int32_t> AbaqusPieces::nodes(std::size_t piece,
                                              const std::vector<AbaqusModel::Picked>& picked,
                                              const std::string& name) const {
  std::vector<std::int32_t> all;
  for (const AbaqusModel::Picked& one : picked) {
    const Piece& from = one.instance < 0 ? pieces_[piece] : pieces_[index(one.instance) + 1];
    if (one.elements_nodes) {
      for (std::int32_t place : elements(piece, {one}, name)) {
        const Element& element = elements_[index(place)];
        all.insert(all.end(), nodes_of(element), nodes_of(element) + element.type->nodes);
      }
      continue;
    }
    each_of(
        one, from.scope->place_of,
        [&](std::int32_t place) { all.push_back(from.first_node + place); },
        [&](std::int64_t number) {
          refuse(one.line, fmt::format("has node {} in '{}', which is not there", number, name),
                 "Take it out, or write the node.");
        });
  }
  return sorted(std::move(all));
}

}  // namespace abut
