// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/surface/skin/pose_quality.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  std::string
  PoseQuality::warning_of_edge() const
  {
    if (!(longest_edge > tolerable_edge))
      return "";
    const std::string why
        = edge_at_rest > tolerable_edge
              ? fmt::format(
                  "the pose shortens it to {} % of its length at rest, which cells hardly "
                  "follow. Make a mesh of more cells (--cells, Mesh/Cells), or pinch the "
                  "surface less there.",
                  short_text(100. / edge_at_rest))
              : "sheets that part there hang together in the mesh. Make the mesh with poses that "
                "part them (exemplar mesh --poses), or of more cells.";
    return fmt::format("the edge between vertices {} and {} (at {}, {}, {} in this pose) becomes "
                       "{} times as long as the pose has it: {}",
                       edge[0], edge[1], short_text(edge_place[0]), short_text(edge_place[1]),
                       short_text(edge_place[2]), short_text(longest_edge), why);
  }

  std::string
  PoseQuality::warning_of_motion() const
  {
    if (!(max_error > std::max(least_visible, hardly_followed * motion)))
      return "";
    return fmt::format(
        "the pose is hardly followed: vertex {} (at {}, {}, {} in it) stays {} % of the diagonal "
        "away, and no vertex moves by more than {} %. The cells there are too large. Make a mesh "
        "of more cells (--cells, Mesh/Cells).",
        vertex, short_text(vertex_place[0]), short_text(vertex_place[1]),
        short_text(vertex_place[2]), short_text(100. * max_error), short_text(100. * motion));
  }
} // namespace Exemplar
