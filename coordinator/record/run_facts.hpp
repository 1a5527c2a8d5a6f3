#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "coordinator/record/observer.hpp"

namespace abut {

// What summary.json and progress.json say of a run that does not change while it goes on.

/// null: not finite.
nlohmann::ordered_json json_number(double value);

/// `units`: the scene's words for those of SI; empty: these.
nlohmann::ordered_json bodies_json(const RunStart& start,
                                   const std::map<std::string, std::string>& units);

/// Where the ports of 1D bodies are: turns displacements and forces of the history into positions
/// and compression.
nlohmann::ordered_json ports_json(const RunStart& start);

/// Sides, and whether they are one from the start.
nlohmann::ordered_json interfaces_json(const RunStart& start);

}  // namespace abut
