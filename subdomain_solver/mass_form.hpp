#pragma once

namespace abut {

/// Mass matrix; averaged is the mean of the other two. Of a two-node bar element it is
/// m_e [[1/2 - b, b], [b, 1/2 - b]] with b = 0, 1/12, 1/6.
enum class MassForm { lumped, averaged, consistent };

}  // namespace abut
