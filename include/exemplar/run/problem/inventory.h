// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_inventory_h
#define exemplar_inventory_h

#include <exemplar/run/problem/problem.h>

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A kind of part that a problem may have, with its name in summary.json.
  struct PartOfProblem
  {
    std::string                name;
    std::optional<bool>        is_there; ///< for `used` and `left_out`; none: in every problem
    std::optional<std::size_t> bytes;    ///< for `memory_mib`: 0 if it is not there; none: it is
                                         ///< not told
  };

  /// All kinds of parts, with their presence and memory in this problem.
  std::vector<PartOfProblem>
  inventory(const Problem &problem);
} // namespace Exemplar

#endif
