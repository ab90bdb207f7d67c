// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/length_filter.h>
#include <exemplar/body/parts_of_graph.h>
#include <exemplar/body/weight_regions.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/expression.h>

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Length over which densities of strain are spread, over the cube root of the volume.
    const double spread_length = 0.1 * std::sqrt(12.);

    /// Length over which regions pass into each other, over the cube root of the smallest one's volume.
    constexpr double blended_length = 0.25;

    /// Poses with less strain than this are rigid motions, but for rounding.
    constexpr double least_strain = 1e-6;

    /// Lesser shares of regions that are elsewhere do not matter; a region keeps this where it is.
    constexpr double smallest_share = 1e-2;

    /// |U - I|^2 of the stretch in a deformation gradient.
    double
    squared_stretch(const Matrix3<double> &F)
    {
      dealii::SymmetricTensor<2, 3> C;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = a; b < 3; ++b)
          for (unsigned int c = 0; c < 3; ++c)
            C[a][b] += F[c][a] * F[c][b];
      double sum = 0.;
      for (const double square : dealii::eigenvalues(C))
        sum += std::pow(std::sqrt(std::max(square, 0.)) - 1., 2);
      return sum;
    }

    double
    volume_of(const FESpace &linear)
    {
      double sum = 0.;
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
        sum += linear.volume(cell);
      return sum;
    }

    /// What poses strain: densities at the nodes, and names.
    struct Strained
    {
      std::vector<std::vector<double>> densities; ///< [1/m^3], with the integral 1
      std::vector<std::string>         names;
    };

    /// The densities of a pose's strains in the cells; empty for a rigid motion and what is no pose.
    std::vector<double>
    density_in_cells(const FESpace &linear, const std::vector<dealii::Point<3>> &places)
    {
      Vector positions(linear.n_dofs());
      for (unsigned int node = 0; node < linear.n_nodes(); ++node)
        for (unsigned int c = 0; c < 3; ++c)
          positions[3 * node + c] = places[node][c];
      std::vector<double> density;
      double              sum = 0.;
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
      {
        density.push_back(squared_stretch(linear.deformation_gradient(cell, positions)));
        sum += linear.volume(cell) * density.back();
      }
      if (!std::isfinite(sum) || sum <= least_strain * least_strain * volume_of(linear))
        return {};
      for (double &value : density)
        value /= sum;
      return density;
    }

    Strained
    strained_by(const std::vector<PoseOfBody> &poses, const FESpace &linear)
    {
      Strained           result;
      const LengthFilter filter(linear, spread_length * std::cbrt(volume_of(linear)));
      for (const auto &[name, places] : poses)
      {
        const std::vector<double> density = density_in_cells(linear, places);
        if (density.empty())
          continue;
        std::vector<double> spread(linear.n_nodes(), 0.);
        for (unsigned int cell = 0; cell < density.size(); ++cell)
          filter.add(cell, density[cell], spread.data());
        filter.solve(spread);
        for (double &value : spread) // obtuse cells can push it a little below zero
          value = std::max(value, 0.);
        result.densities.push_back(std::move(spread));
        result.names.push_back(name);
      }
      return result;
    }

    /// The volume at each node.
    std::vector<double>
    measures_of(const FESpace &linear)
    {
      std::vector<double> measures(linear.n_nodes(), 0.);
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
        for (const unsigned int node : linear.nodes(cell))
          measures[node] += 0.25 * linear.volume(cell);
      return measures;
    }

    /// Leave only shares that matter, with the sum one, in each cell.
    void
    tidy(std::vector<std::vector<double>> &shares,
         const std::vector<unsigned int>  &part,
         const FESpace                    &linear)
    {
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
      {
        for (auto &of_region : shares)
          of_region[cell] = of_region[cell] < smallest_share ? 0. : of_region[cell];
        for (const unsigned int node : linear.nodes(cell))
          shares[part[node]][cell] = std::max(shares[part[node]][cell], smallest_share);
        double sum = 0.;
        for (const auto &of_region : shares)
          sum += of_region[cell];
        for (auto &of_region : shares)
          of_region[cell] /= sum;
      }
    }

    /// The share of each part of the nodes in each cell.
    std::vector<std::vector<double>>
    shares_of(const std::vector<unsigned int> &part,
              const unsigned int               n_parts,
              const FESpace                   &linear,
              const double                     length)
    {
      const std::size_t   n = linear.n_nodes();
      std::vector<double> columns(n * n_parts, 0.);
      const LengthFilter  filter(linear, length);
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
        for (const unsigned int node : linear.nodes(cell))
          filter.add(cell, 0.25, &columns[part[node] * n]);
      filter.solve(columns);
      std::vector<std::vector<double>> shares(n_parts);
      for (unsigned int region = 0; region < n_parts; ++region)
        for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
          shares[region].push_back(filter.mean(cell, &columns[region * n]));
      tidy(shares, part, linear);
      return shares;
    }

    /// The name of the pose that has most of its strains in a part.
    std::string
    strongest_in(const unsigned int               region,
                 const std::vector<unsigned int> &part,
                 const std::vector<double>       &measures,
                 const Strained                  &strained)
    {
      std::string name;
      double      most = 0.;
      for (std::size_t pose = 0; pose < strained.names.size(); ++pose)
      {
        double sum = 0.;
        for (std::size_t node = 0; node < part.size(); ++node)
          if (part[node] == region)
            sum += measures[node] * strained.densities[pose][node];
        if (sum > most)
          name = strained.names[pose];
        most = std::max(most, sum);
      }
      return name;
    }

    /// Describe the regions with these shares.
    std::vector<WeightRegion>
    describe(const std::vector<std::vector<double>> &shares,
             const Mesh                             &mesh,
             const FESpace                          &linear)
    {
      std::vector<WeightRegion> regions(shares.size(), { 0, 0., {}, "" });
      const double              volume = volume_of(linear);
      for (unsigned int cell = 0; cell < linear.n_cells(); ++cell)
      {
        dealii::Point<3> middle;
        for (const unsigned int node : linear.nodes(cell))
          middle += 0.25 * mesh.get_nodes()[node];
        unsigned int greatest = 0;
        for (unsigned int region = 0; region < shares.size(); ++region)
        {
          const double part = shares[region][cell] * linear.volume(cell) / volume;
          regions[region].volume += part;
          regions[region].centre += part * middle;
          if (shares[region][cell] > shares[greatest][cell])
            greatest = region;
        }
        ++regions[greatest].n_cells;
      }
      for (WeightRegion &region : regions)
        region.centre /= region.volume;
      return regions;
    }
  } // namespace

  std::vector<PoseOfBody>
  poses_of_body(const ExampleParameters &parameters, const Mesh &mesh, const NamedPoses &named)
  {
    std::vector<PoseOfBody> poses;
    for (const std::string &name : parameters.poses)
      poses.push_back({ name, mesh.find_pose(named, name, "Examples/Poses") });
    for (const std::string &function : split_trimmed(parameters.pose_functions, '|'))
    {
      const Expression expression("Examples/Pose functions", function, "xyz", 3);
      poses.push_back({ function, {} });
      for (const dealii::Point<3> &node : mesh.get_nodes())
        poses.back().places.emplace_back(expression.vector(node, 0.));
    }
    return poses;
  }

  WeightRegions
  find_weight_regions(const Mesh                    &mesh,
                      const std::vector<PoseOfBody> &poses,
                      const double                   blend_length)
  {
    const FESpace                   linear(mesh);
    const Strained                  strained = strained_by(poses, linear);
    const std::vector<double>       measures = measures_of(linear);
    const std::vector<unsigned int> part
        = parts_of_graph(edges_of(mesh.get_cells()), measures, strained.densities);
    const unsigned int  n = *std::max_element(part.begin(), part.end()) + 1;
    std::vector<double> volumes(n, 0.);
    for (std::size_t node = 0; node < part.size(); ++node)
      volumes[part[node]] += measures[node];
    const double  length = blend_length > 0. ? std::min(blend_length, 1e3 * mesh.diameter())
                                             : blended_length * std::cbrt(volumes.back());
    WeightRegions result;
    result.shares
        = n == 1 ? std::vector<std::vector<double>>(1, std::vector<double>(linear.n_cells(), 1.))
                 : shares_of(part, n, linear, length);
    result.regions = describe(result.shares, mesh, linear);
    for (unsigned int region = 0; region < n; ++region)
      result.regions[region].example = strongest_in(region, part, measures, strained);
    if (n == 1)
      result.shares.clear();
    return result;
  }
} // namespace Exemplar
