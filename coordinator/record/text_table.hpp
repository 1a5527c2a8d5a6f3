#pragma once

#include <string>
#include <vector>

namespace abut {

/// Rows of cells for people, the first of them the headings: the first column at the left, numbers
/// at the right. Every row has as many cells as the first; each line begins with `indent`.
std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       const std::string& indent = "");

}  // namespace abut
