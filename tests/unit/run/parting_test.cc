// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_generation.h>
#include <exemplar/run/inputs/parcel.h>
#include <exemplar/run/scene/scene_parameters.h>

#include "expect_contains.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr unsigned int n_processes = 3;

    /// A bar of two regions, held at an end, with a pose.
    BodyInputs
    inputs_of_bar(const Element element)
    {
      SceneParameters scene;
      scene.scene         = SceneKind::statics;
      scene.model.element = element;
      scene.handles.emplace_back();
      scene.handles[0].name        = "left";
      scene.handles[0].select.text = "boundary 1";
      scene.material.regions[2]    = ElasticConstants{ MaterialPreset::none, 2e6, 0.3, 500. };
      Inputs inputs;
      inputs.mesh = generate_box({ { 6., 2., 2. } }, { { 6, 2, 2 } });
      for (MshElement &cell : inputs.mesh.elements)
        if (cell.type == MshElementType::tetrahedron)
          cell.physical = inputs.mesh.nodes[cell.nodes[0]][0] < 3. ? 1 : 2;
      for (const dealii::Point<3> &node : inputs.mesh.nodes)
        inputs.poses["stretched"].emplace_back(1.1 * node[0], node[1], node[2]);
      return make_body_inputs(scene, std::move(inputs));
    }

    std::vector<PartOfBody>
    parts_of(const BodyInputs &whole, const Element element, const unsigned int n = n_processes)
    {
      return part_body(whole.mesh, whole.fields.patches, element, n);
    }

    std::vector<unsigned int>
    from_0_to(const unsigned int n)
    {
      std::vector<unsigned int> numbers(n);
      std::iota(numbers.begin(), numbers.end(), 0u);
      return numbers;
    }

    /// What the parts have, in ascending order.
    template <typename List>
    std::vector<unsigned int>
    together(const std::vector<PartOfBody> &parts, const List &list)
    {
      std::vector<unsigned int> all;
      for (const PartOfBody &part : parts)
      {
        const std::vector<unsigned int> &own = list(part);
        all.insert(all.end(), own.begin(), own.end());
      }
      std::sort(all.begin(), all.end());
      return all;
    }

    TEST(Parting, EachCellAndEachFaceIsOfOneProcess)
    {
      const BodyInputs whole = inputs_of_bar(Element::P1);
      const auto       parts = parts_of(whole, Element::P1);
      EXPECT_EQ(together(
                    parts, [](const PartOfBody &part) -> auto & { return part.cells; }),
                from_0_to(whole.mesh.n_cells()));
      EXPECT_EQ(together(
                    parts, [](const PartOfBody &part) -> auto & { return part.faces; }),
                from_0_to(whole.mesh.get_boundary_faces().size()));
    }

    TEST(Parting, AFaceIsWithItsCell)
    {
      const BodyInputs whole = inputs_of_bar(Element::P1);
      for (const PartOfBody &part : parts_of(whole, Element::P1))
        for (const unsigned int face : part.faces)
          for (const unsigned int node : whole.mesh.get_boundary_faces()[face].nodes)
            EXPECT_TRUE(
                std::binary_search(part.nodes.in_files.begin(), part.nodes.in_files.end(), node));
    }

    TEST(Parting, EachNodeHasOneNumberOfOneOwner)
    {
      for (const Element element : { Element::P1, Element::P2 })
      {
        const BodyInputs                     whole = inputs_of_bar(element);
        std::map<unsigned int, unsigned int> number;
        std::set<unsigned int>               numbers;
        const auto                           parts = parts_of(whole, element);
        for (const PartOfBody &part : parts)
        {
          ASSERT_EQ(part.nodes.first_numbers, parts[0].nodes.first_numbers);
          for (std::size_t i = 0; i < part.nodes.in_files.size(); ++i)
          {
            const unsigned int own = part.nodes.numbers[i];
            EXPECT_EQ(number.emplace(part.nodes.in_files[i], own).first->second, own);
            numbers.insert(own);
          }
        }
        EXPECT_EQ(number.size(), numbers.size());
        EXPECT_EQ(number.size(), parts[0].nodes.first_numbers.back());
        EXPECT_EQ(*numbers.rbegin() + 1, numbers.size());
        EXPECT_GE(number.size(), whole.mesh.n_nodes());
      }
    }

    TEST(Parting, PatchesStayWhole)
    {
      const BodyInputs whole = inputs_of_bar(Element::P1);
      ASSERT_FALSE(whole.fields.patches.empty());
      std::map<unsigned int, std::size_t> process_of_patch;
      const auto                          parts = parts_of(whole, Element::P1);
      for (std::size_t process = 0; process < parts.size(); ++process)
        for (const unsigned int cell : parts[process].cells)
          EXPECT_EQ(process_of_patch.emplace(whole.fields.patches[cell], process).first->second,
                    process);
    }

    TEST(Parting, MoreProcessesThanPatchesAreRefused)
    {
      const BodyInputs whole = inputs_of_bar(Element::P1);
      try
      {
        parts_of(whole, Element::P1, whole.mesh.n_cells());
        FAIL() << "not refused";
      }
      catch (const UserError &error)
      {
        expect_contains(error.what(), "in patches that stay whole. Start fewer with mpirun -n.");
      }
    }

    TEST(Parting, AParcelHoldsWhatTheWholeSaysOfItsCellsAndNodes)
    {
      const BodyInputs whole  = inputs_of_bar(Element::P1);
      std::size_t      n_held = 0;
      for (const PartOfBody &part : parts_of(whole, Element::P1))
      {
        const Parcel      parcel = parcel_of(whole, part);
        const MeshArrays &own    = parcel.mesh.arrays;
        const auto       &places = parcel.fields.poses.at("stretched");
        ASSERT_EQ(own.cells.size(), part.cells.size());
        for (unsigned int cell = 0; cell < part.cells.size(); ++cell)
        {
          const auto &corners = whole.mesh.get_cells()[part.cells[cell]];
          EXPECT_EQ(own.element_numbers[cell], whole.mesh.element_number(part.cells[cell]));
          EXPECT_EQ(parcel.fields.material.density(cell),
                    whole.fields.material.density(part.cells[cell]));
          for (unsigned int v = 0; v < 4; ++v)
          {
            const unsigned int here = own.cells[cell][v];
            EXPECT_EQ(own.contents.nodes[here], whole.mesh.get_nodes()[corners[v]]);
            EXPECT_EQ(places[here], whole.fields.poses.at("stretched")[corners[v]]);
          }
        }
        for (const unsigned int here : parcel.fields.nodes.at("boundary 1"))
          EXPECT_EQ(own.contents.nodes[here][0], 0.);
        for (unsigned int node = 0; node < own.contents.nodes.size(); ++node)
          n_held += own.contents.nodes[node][0] == 0. ? 1 : 0;
        n_held -= parcel.fields.nodes.at("boundary 1").size();
      }
      EXPECT_EQ(n_held, 0u);
    }
  } // namespace
} // namespace Exemplar::Testing
