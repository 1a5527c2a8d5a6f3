#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "subdomain_solver/fe/abaqus_collapsed.hpp"
#include "subdomain_solver/fe/abaqus_model.hpp"

namespace abut {

/// All nodes and elements of a file's instances in one row, where its sets and numbers lead to.
class AbaqusPieces {
 public:
  /// The assembly's own nodes and elements, then an instance or, where there are none, a part each.
  struct Piece {
    const AbaqusModel::Scope* scope = nullptr;
    std::string name;  // of the instance; empty: the assembly
    std::int32_t first_node = 0;
    std::unordered_map<std::int64_t, std::int32_t> element_of;  // of an element's number
  };
  struct Element {
    const AbaqusElement* type = nullptr;  // what it has collapsed to, where nodes repeat
    std::string_view name;                // of the type, as written
    std::int64_t number = 0;
    AbaqusLine line;
    std::size_t begin = 0;  // of its nodes
  };

  /// Throws InputError: elements of unknown nodes, with a number twice, or with a node twice where
  /// that makes no shape.
  AbaqusPieces(const AbaqusModel& model, const AbaqusCursor& file);

  const std::vector<Piece>& pieces() const { return pieces_; }
  const std::vector<Element>& elements() const { return elements_; }
  /// How many elements whose nodes repeat are of which shape.
  const std::map<std::string, int>& collapsed_to() const { return collapsed_to_; }
  const std::int32_t* nodes_of(const Element& element) const { return &nodes_[element.begin]; }
  const std::vector<double>& points() const { return points_; }           // (nodes, 3)
  const std::vector<std::uint64_t>& numbers() const { return numbers_; }  // (nodes)

  /// What a set of a piece has: places of nodes or elements, sorted, each once. Throws InputError
  /// where it names one that is not there; `name` is the set's.
  std::vector<std::int32_t> nodes(std::size_t piece, const std::vector<AbaqusModel::Picked>& picked,
                                  const std::string& name) const;
  std::vector<std::int32_t> elements(std::size_t piece,
                                     const std::vector<AbaqusModel::Picked>& picked,
                                     const std::string& name) const;

 private:
  void add_piece(const AbaqusModel::Scope& scope, const AbaqusModel::Instance* instance,
                 const std::string& name);
  void add_elements(Piece& piece, const AbaqusModel::Elements& block);
  void collapse(Element& element);
  [[noreturn]] void refuse(AbaqusLine line, const std::string& what,
                           const std::string& remedy) const;

  const AbaqusCursor& file_;
  std::vector<Piece> pieces_;
  std::vector<Element> elements_;
  std::vector<std::int32_t> nodes_;
  std::vector<double> points_;
  std::vector<std::uint64_t> numbers_;
  /// What elements are whose nodes repeat in these ways.
  std::map<std::pair<const AbaqusElement*, std::vector<int>>, std::optional<CollapsedElement>>
      shapes_;
  std::map<std::string, int> collapsed_to_;
};

}  // namespace abut
