// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_standing_surface_h
#define exemplar_standing_surface_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/body_contacts.h>
#include <exemplar/obstacles/box_tree.h>

#include <vector>

namespace Exemplar
{
  /// Parts of a surface that are somewhere: the pairs that are near each other, and where it crosses itself.
  class StandingSurface
  {
  public:
    using Place = dealii::Tensor<1, 3>;

    /// All must outlive it.
    StandingSurface(const BodyContacts   &contacts,
                    const ContactSurface &surface,
                    const Vector         &positions)
        : contacts(contacts), surface(surface), positions(positions)
    {
    }

    /// A pair, its distance [m] and its place.
    struct Near
    {
      BodyPair pair;
      double   distance;
      Place    place;
    };

    /// Those that are nearer than the usual width of their pieces.
    std::vector<Near>
    near_pairs() const;

    /// The pairs of an edge that passes through a triangle with that: ends and triangle, edge and sides; by their keys, with a
    /// place.
    std::vector<Near>
    crossing_pairs() const;

  private:
    Place
    x(const unsigned int node) const
    {
      return contacts.points.value(positions, node);
    }

    template <typename Nodes>
    AxisBox
    box_of(const Nodes &nodes) const
    {
      AxisBox box;
      for (const unsigned int node : nodes)
        box.add(x(node));
      return box;
    }

    void
    add_crossing(unsigned int edge, unsigned int triangle, std::vector<Near> &to) const;

    const BodyContacts   &contacts;
    const ContactSurface &surface;
    const Vector         &positions;
  };
} // namespace Exemplar

#endif
