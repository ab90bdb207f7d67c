// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/patches.h>

#include "body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    struct PatchedBody
    {
      explicit PatchedBody(const MshFile &contents)
          : mesh(contents, "test"), material(MaterialParameters(), mesh.get_material_ids()),
            fe_space(mesh),
            patches(Patches::choose(mesh, material, Element::P1), fe_space, material)
      {
      }

      const Mesh     mesh;
      const Material material;
      const FESpace  fe_space;
      const Patches  patches;
    };

    TEST(Patches, HoldEveryCellOnce)
    {
      const PatchedBody body(bar_of_two_regions(2., box_mesh(4., 8, 2)));
      std::vector<int>  times(body.mesh.n_cells(), 0);
      double            volume = 0.;
      for (unsigned int patch = 0; patch < body.patches.size(); ++patch)
      {
        volume += body.patches.volume(patch);
        for (const unsigned int cell : body.patches.points(patch))
        {
          ++times[cell];
          EXPECT_EQ(body.patches.of_point(cell), patch);
        }
      }
      EXPECT_EQ(times, std::vector<int>(body.mesh.n_cells(), 1));
      EXPECT_NEAR(volume, 4., 1e-12);
      EXPECT_LT(body.patches.size(), body.mesh.n_cells() / 9);
    }

    TEST(Patches, LieInOneRegion)
    {
      const PatchedBody body(bar_of_two_regions(2.5, box_mesh(4., 8, 2)));
      for (unsigned int patch = 0; patch < body.patches.size(); ++patch)
        for (const unsigned int cell : body.patches.points(patch))
          EXPECT_EQ(body.mesh.get_material_ids()[cell],
                    body.mesh.get_material_ids()[body.patches.points(patch).front()]);
    }

    TEST(Patches, OfACellThatIsARegionIsThatCell)
    {
      MshFile contents = Mesh(box_mesh(4., 4, 1)).get_contents();
      for (MshElement &element : contents.elements)
        element.physical = element.type == MshElementType::tetrahedron ? 1 : 0;
      const auto first = std::find_if(contents.elements.begin(), contents.elements.end(),
                                      [](const MshElement &element)
                                      { return element.type == MshElementType::tetrahedron; });
      first->physical  = 2;
      const PatchedBody body(contents);
      EXPECT_EQ(body.patches.points(body.patches.of_point(0)), std::vector<unsigned int>{ 0 });
    }

    TEST(Patches, LambdaIsTheMeanOverTheVolume)
    {
      const Mesh           mesh(box_mesh(4., 4, 1));
      const FESpace        fe_space(mesh);
      PaintedMaterial      painted;
      std::vector<double> &values = painted.youngs_modulus.values;
      values.resize(mesh.n_cells(), 1.);
      for (unsigned int cell = 0; cell < values.size(); ++cell)
        values[cell] = cell % 2 == 0 ? 1. : 1.2;
      const Material material(MaterialParameters(), mesh.get_material_ids(), {}, painted);
      const Patches  patches(Patches::choose(mesh, material, Element::P1), fe_space, material);
      EXPECT_LT(patches.size(), mesh.n_cells());
      for (unsigned int patch = 0; patch < patches.size(); ++patch)
      {
        double sum = 0., volume = 0.;
        for (const unsigned int cell : patches.points(patch))
        {
          sum += fe_space.volume(cell) * material.elasticity(cell).lambda;
          volume += fe_space.volume(cell);
        }
        EXPECT_NEAR(patches.lambda(patch) / (sum / volume), 1., 1e-14);
      }
    }

    // The node in the middle of 2 x 2 x 2 cubes has the most cells, so there is no tie.
    TEST(Patches, TakeTheGreatestStarWhole)
    {
      const PatchedBody         body(Mesh(box_mesh(2., 2, 2)).get_contents());
      std::vector<unsigned int> n_cells(body.mesh.n_nodes(), 0);
      for (const auto &cell : body.mesh.get_cells())
        for (const unsigned int node : cell)
          ++n_cells[node];
      const auto middle = static_cast<unsigned int>(std::max_element(n_cells.begin(), n_cells.end())
                                                    - n_cells.begin());
      std::set<unsigned int> patches;
      for (unsigned int cell = 0; cell < body.mesh.n_cells(); ++cell)
        for (const unsigned int node : body.mesh.get_cells()[cell])
          if (node == middle)
            patches.insert(body.patches.of_point(cell));
      EXPECT_EQ(patches.size(), 1u);
    }
  } // namespace
} // namespace Exemplar::Testing
