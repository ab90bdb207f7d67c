// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/closest_features.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/run/problem/pieces_apart.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    /// Two pieces must go apart: (way of second - way of first) . normal >= by.
    struct Parting
    {
      unsigned int first, second;
      SpaceVector3 normal;
      double       by;     ///< [m]
      double       margin; ///< by which they go farther, so that few rounds do [m]
    };

    /// Where pieces face each other.
    class FacingPieces
    {
    public:
      FacingPieces(const std::map<PiecePair, TouchingPieces> &touching,
                   const BodyContacts                        &contacts,
                   const ContactSurface                      &surface,
                   const Vector                              &positions)
          : touching(touching), contacts(contacts), surface(surface), positions(positions)
      {
        for (const auto &[of, how] : touching)
          farthest = std::max(farthest, how.near);
      }

      std::vector<Parting>
      partings()
      {
        std::vector<AxisBox>      boxes;
        std::vector<SpaceVector3> of_nodes(surface.nodes.size());
        for (unsigned int t = 0; t < surface.triangles.size(); ++t)
        {
          AxisBox            box;
          const SpaceVector3 n = area_normal(t);
          for (const unsigned int node : surface.triangles[t].nodes)
          {
            box.add(x(node));
            of_nodes[surface.number_of_node(node)] += n;
          }
          boxes.push_back(box);
        }
        tree = BoxTree(boxes);
        for (unsigned int i = 0; i < surface.nodes.size(); ++i)
          look_from(x(surface.nodes[i].node), of_nodes[i], contacts.pieces[surface.nodes[i].node]);
        for (unsigned int t = 0; t < surface.triangles.size(); ++t)
        {
          const auto &n = surface.triangles[t].nodes;
          look_from((x(n[0]) + x(n[1]) + x(n[2])) / 3., area_normal(t), contacts.pieces[n[0]]);
        }
        return std::move(found);
      }

    private:
      SpaceVector3
      x(const unsigned int node) const
      {
        return at_node(positions, node);
      }

      SpaceVector3
      area_normal(const unsigned int t) const
      {
        const auto &n = surface.triangles[t].nodes;
        return dealii::cross_product_3d(x(n[1]) - x(n[0]), x(n[2]) - x(n[0]));
      }

      /// The nearest triangle of another piece that a place of a surface faces, for each piece.
      struct Facing
      {
        double       distance; ///< [m]
        double       cosine;   ///< of the normals
        unsigned int triangle;
      };

      void
      look_from(const SpaceVector3 &place, const SpaceVector3 &outwards, const unsigned int piece)
      {
        constexpr double facing = -0.5, same_distance = 1e-9;
        AxisBox          box;
        box.add(place);
        std::map<unsigned int, Facing> best;
        tree.visit(box.widened(farthest),
                   [&](const unsigned int t)
                   {
                     const auto        &n      = surface.triangles[t].nodes;
                     const unsigned int other  = contacts.pieces[n[0]];
                     const auto         how    = touching.find(std::minmax(piece, other));
                     const SpaceVector3 normal = area_normal(t);
                     if (other == piece || how == touching.end() || normal.norm() == 0.
                         || outwards.norm() == 0.)
                       return;
                     const std::array<SpaceVector3, 3> corners{ { x(n[0]), x(n[1]), x(n[2]) } };
                     const double distance = nearest(corners, place).way.norm();
                     const double cosine   = normal * outwards / (normal.norm() * outwards.norm());
                     const auto   before   = best.find(other);
                     const double slack    = same_distance * contacts.diameters[piece];
                     if (distance < how->second.near
                         && (before == best.end() || distance < before->second.distance - slack
                             || (distance <= before->second.distance + slack
                                 && cosine < before->second.cosine)))
                       best[other] = { distance, cosine, t };
                   });
        for (const auto &[other, at] : best)
          if (at.cosine < facing)
            add(place, piece, other, at.triangle);
      }

      void
      add(const SpaceVector3 &place,
          const unsigned int  piece,
          const unsigned int  other,
          const unsigned int  triangle)
      {
        constexpr double   same_direction = 1. - 1e-8;
        const SpaceVector3 area = area_normal(triangle), n = area / area.norm();
        const double       gap       = (place - x(surface.triangles[triangle].nodes[0])) * n;
        constexpr double   part_more = 0.05;
        const double       distance  = touching.at(std::minmax(piece, other)).distance;
        Parting            parting{ other, piece, n, distance - gap, part_more * distance };
        if (piece < other)
        {
          std::swap(parting.first, parting.second);
          parting.normal *= -1.;
        }
        for (Parting &known : found)
          if (known.first == parting.first && known.second == parting.second
              && known.normal * parting.normal > same_direction)
          {
            known.by = std::max(known.by, parting.by);
            return;
          }
        found.push_back(parting);
      }

      const std::map<PiecePair, TouchingPieces> &touching;
      const BodyContacts                        &contacts;
      const ContactSurface                      &surface;
      const Vector                              &positions;
      double                                     farthest = 0.;
      BoxTree                                    tree;
      std::vector<Parting>                       found;
    };

    /// For each piece the least one of those that are tied to it.
    std::vector<unsigned int>
    groups_of_tied(const BodyContacts &contacts)
    {
      std::vector<unsigned int> group(contacts.diameters.size());
      std::iota(group.begin(), group.end(), 0U);
      for (const auto &[node, piece] : contacts.tied)
      {
        const auto [low, high] = std::minmax(group[contacts.pieces[node]], group[piece]);
        std::replace(group.begin(), group.end(), unsigned(high), unsigned(low));
      }
      return group;
    }
  } // namespace

  std::vector<dealii::Tensor<1, 3>>
  ways_of_pieces_apart(const std::map<PiecePair, TouchingPieces> &touching,
                       const BodyContacts                        &contacts,
                       const ContactSurface                      &surface,
                       const Vector                              &positions,
                       const std::set<unsigned int>              &staying)
  {
    constexpr std::size_t most_looks = 50000000; // at partings: a row of n pieces takes n^2 rounds
    constexpr double      farthest   = 10.;      // times what all partings have together
    std::vector<Parting> partings = FacingPieces(touching, contacts, surface, positions).partings();
    const std::vector<unsigned int> group = groups_of_tied(contacts);
    std::vector<char>               stays(group.size(), 0);
    for (const unsigned int piece : staying)
      stays[group[piece]] = 1;
    const auto cannot_part = [&](const Parting &parting)
    {
      const unsigned int a = group[parting.first], b = group[parting.second];
      return a == b || (stays[a] != 0 && stays[b] != 0);
    };
    partings.erase(std::remove_if(partings.begin(), partings.end(), cannot_part), partings.end());
    std::vector<SpaceVector3> ways(group.size());
    double                    limit = 0.;
    for (const Parting &parting : partings)
      limit += farthest * std::max(0., parting.by);
    bool is_apart = partings.empty(), is_lost = false;
    for (std::size_t looks = 0; looks < most_looks && !is_apart && !is_lost;
         looks += partings.size())
    {
      is_apart = true;
      for (const Parting &parting : partings)
      {
        const unsigned int a = group[parting.first], b = group[parting.second];
        const double       missing = parting.by - (ways[b] - ways[a]) * parting.normal;
        if (!(missing > 0.))
          continue;
        is_apart            = false;
        const double movers = (stays[a] != 0 ? 0. : 1.) + (stays[b] != 0 ? 0. : 1.);
        const double each   = (missing + parting.margin) / movers;
        if (stays[a] == 0)
          ways[a] -= each * parting.normal;
        if (stays[b] == 0)
          ways[b] += each * parting.normal;
        is_lost = is_lost || std::max(ways[a].norm(), ways[b].norm()) > limit;
      }
    }
    if (!is_apart)
      return {};
    std::vector<dealii::Tensor<1, 3>> result;
    for (const unsigned int of : group)
      result.push_back(ways[of]);
    return result;
  }
} // namespace Exemplar
