// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/surface/skin/pose_quality.h>

#include <fmt/core.h>

namespace Exemplar
{
  std::string
  PoseQuality::warning_of_edge() const
  {
    if (!(longest_edge > tolerable_edge))
      return "";
    return fmt::format(
        "the edge between vertices {} and {} (at {}, {}, {} in this pose) becomes {} "
        "times as long as the pose has it: sheets that part there hang together in "
        "the mesh. Make the mesh with poses that part them (exemplar mesh --poses), "
        "or of more cells.",
        edge[0], edge[1], short_text(edge_place[0]), short_text(edge_place[1]),
        short_text(edge_place[2]), short_text(longest_edge));
  }
} // namespace Exemplar
