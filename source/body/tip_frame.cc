// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/tip_frame.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// The part of an edge's length by which it may leave a plane in which it lies.
    constexpr double out_of_plane = 1e-3;

    Vector3<double>
    turned(const Vector3<double> &v, const Vector3<double> &axis, const double angle)
    {
      const Vector3<double> across = combine(1., v, -dot(axis, v), axis);
      return combine(1., times(dot(axis, v), axis), 1.,
                     combine(std::cos(angle), across, std::sin(angle), cross(axis, v)));
    }

    Vector3<double>
    direction(const Vector3<double> &begin, const Vector3<double> &end)
    {
      const Vector3<double> edge = difference(end, begin);
      return times(1. / norm(edge), edge);
    }

    Vector3<double>
    middle_of(const Vector3<double> &begin, const Vector3<double> &end)
    {
      return combine(0.5, begin, 0.5, end);
    }

    /// The least turn of the normal at rest into a held axis that is perpendicular to the edge, or into its opposite; of two quarter
    /// turns that out of the first triangle. 0 without such an axis.
    double
    turn_into_axis(const ShellEdge &edge, const Vector3<double> &along, const HeldComponents held)
    {
      for (int c = 0; c < 3; ++c)
        if ((held >> c & 1) != 0 && std::abs(along[c]) <= out_of_plane)
        {
          const double angle = std::atan2(cross(along, edge.normal)[c], edge.normal[c]);
          return angle - M_PI * std::floor((angle + 0.25 * M_PI) / M_PI); // in [-pi/4, 3 pi/4)
        }
      return 0.;
    }
  } // namespace

  TipFrame::TipFrame(const ShellMesh &mesh, const unsigned int edge, const HeldComponents held)
  {
    const ShellEdge       &of    = mesh.edges()[edge];
    const Vector3<double> &begin = mesh.vertex(of.begin), &end = mesh.vertex(of.end);
    const Vector3<double>  along = direction(begin, end);
    angle                        = turn_into_axis(of, along, held);
    middle_at_rest               = middle_of(begin, end);
    for (int c = 0; c < 3; ++c)
    {
      is_held[c] = held >> c & 1;
      Vector3<double> unit{};
      unit[c]                     = 1.;
      const Vector3<double> image = turned(unit, along, angle);
      for (int i = 0; i < 3; ++i)
        turn[i][c] = image[i];
    }
  }

  Vector3<double>
  TipFrame::anchor(const Vector3<double> &middle) const
  {
    Vector3<double> result;
    for (int c = 0; c < 3; ++c)
      result[c] = is_held[c] * middle[c] + (1. - is_held[c]) * middle_at_rest[c];
    return result;
  }

  Vector3<double>
  TipFrame::place(const Vector3<double> &begin,
                  const Vector3<double> &end,
                  const Vector3<double> &node) const
  {
    const Vector3<double> middle = middle_of(begin, end);
    return combine(1., middle, 1., turn * difference(node, anchor(middle)));
  }

  HingeForm<double>
  TipFrame::pulled_back(HingeForm<double> form) const
  {
    Vector3<double> at_node{};
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c)
        at_node[c] += turn[i][c] * form[3][i];
    for (int end = 0; end < 2; ++end)
      for (int c = 0; c < 3; ++c)
        form[end][c] += 0.5 * (form[3][c] - is_held[c] * at_node[c]);
    form[3] = at_node;
    return form;
  }

  Vector3<double>
  TipFrame::node(const Vector3<double> &begin,
                 const Vector3<double> &end,
                 const Vector3<double> &tip) const
  {
    const Vector3<double> middle   = middle_of(begin, end);
    const Vector3<double> director = turned(difference(tip, middle), direction(begin, end), angle);
    Vector3<double>       result   = anchor(middle);
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c)
        result[c] += turn[i][c] * director[i];
    return result;
  }
} // namespace Exemplar
