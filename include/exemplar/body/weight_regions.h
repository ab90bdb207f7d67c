// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_regions_h
#define exemplar_weight_regions_h

#include <exemplar/body/example_parameters.h>
#include <exemplar/mesh/mesh.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// A part of a body that the examples strain apart from others.
  struct WeightRegion
  {
    unsigned int     n_cells; ///< in which its share is the greatest
    double           volume;  ///< fraction of the body's, weighted by shares
    dealii::Point<3> centre;  ///< of its volume, by shares [m]
    std::string      example; ///< the one that has most of its strains there
  };

  /// The regions of Examples/Regions = auto; no shares where there is one region only.
  struct WeightRegions
  {
    std::vector<std::vector<double>> shares; ///< of each region in each cell, with sum one
    std::vector<WeightRegion>        regions;
  };

  /// A pose and its name.
  struct PoseOfBody
  {
    std::string name;
    std::vector<dealii::Point<3>>
        places; ///< of the nodes, and perhaps of middles of edges behind them [m]
  };

  /// The poses of a scene's examples, but for rest. Throws UserError for one that is missing or has another
  /// number of nodes.
  std::vector<PoseOfBody>
  poses_of_body(const ExampleParameters &parameters, const Mesh &mesh, const NamedPoses &named);

  /// The parts of a body that the poses strain alike and apart from others, by descending volume: densities
  /// |U - I|^2 of their stretches U, each over its integral and spread over a tenth of the cube root of the
  /// volume, have bumps there (parts_of_graph()). Poses that are rigid motions do not count. Shares pass into
  /// each other over `blend_length` [m], LengthFilter; 0: a quarter of the cube root of the smallest region's
  /// volume. For tetrahedra, of a single process.
  WeightRegions
  find_weight_regions(const Mesh                    &mesh,
                      const std::vector<PoseOfBody> &poses,
                      double                         blend_length = 0.);
} // namespace Exemplar

#endif
