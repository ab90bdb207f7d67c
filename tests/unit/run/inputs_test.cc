// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_generation.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/scene/scene_file.h>

#include "expect_contains.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <fstream>

namespace Exemplar::Testing
{
  namespace
  {
    /// The bar 4 x 1 x 1 with an array of everything that a file can hold.
    struct Arrays
    {
      Arrays()
      {
        const MshFile box = generate_box({ { 4., 1., 1. } }, { { 4, 1, 1 } });
        nodes             = box.nodes;
        for (const MshElement &element : box.elements)
        {
          const auto *n  = element.nodes.data();
          const auto  at = [&](const int i) { return static_cast<unsigned int>(n[i]); };
          const auto  id = static_cast<unsigned int>(element.physical);
          if (element.type == MshElementType::tetrahedron)
            cells.push_back({ { at(0), at(1), at(2), at(3) } });
          else
            faces.push_back({ { { at(0), at(1), at(2) } }, id });
        }
        material_ids.assign(cells.size(), 1);
        material_ids.back() = 2;
        for (const dealii::Point<3> &x : nodes)
        {
          stretched.emplace_back(1.3 * x[0], x[1], 0.9 * x[2]);
          sheared.emplace_back(x[0] + 0.1 * x[1], x[1], x[2]);
        }
      }

      std::vector<dealii::Point<3>>            nodes, stretched, sheared;
      std::vector<std::array<unsigned int, 4>> cells;
      std::vector<unsigned int>                material_ids;
      std::vector<BoundaryFace>                faces;
      std::vector<unsigned int>                loaded = { 2, 7 };
    };

    /// A scene that asks for every kind of input.
    SceneParameters
    scene_of(const std::string &stretched, const std::string &sheared, const std::string &loaded)
    {
      SceneParameters scene;
      scene.scene                  = SceneKind::statics;
      scene.mesh.scale             = 0.5;
      scene.examples.poses         = { stretched, sheared };
      scene.material.regions[2]    = ElasticConstants{ MaterialPreset::none, 2e6, 0.3, 1000. };
      scene.initial.pose           = sheared;
      scene.time.increments        = 2;
      scene.loads.gravity          = { { 0., 0., -1. } };
      scene.handles                = { HandleParameters(), HandleParameters() };
      scene.handles[0].name        = "left";
      scene.handles[0].select      = { "boundary 1" };
      scene.handles[1].name        = "right";
      scene.handles[1].select      = { "boundary 2" };
      scene.handles[1].follow_pose = stretched;
      scene.loads.named            = { LoadParameters() };
      scene.loads.named[0].name    = "push";
      scene.loads.named[0].select  = { "nodes " + loaded };
      scene.loads.named[0].force   = "0; 0; 10*t";
      return scene;
    }

    State
    solve(Problem &problem)
    {
      while (problem.state.step < problem.time_axis.n_steps())
        if (!is_success(problem.advance().status))
          throw SolverFailure("no success");
      return problem.state;
    }

    template <typename Function>
    std::string
    refusal(const Function &function)
    {
      try
      {
        function();
      }
      catch (const UserError &error)
      {
        return error.what();
      }
      return "no UserError";
    }

    class InputsTest : public InTemporaryDirectory
    {
    protected:
      std::string
      write_pose(const std::vector<dealii::Point<3>> &nodes, const std::string &name) const
      {
        write_msh(make_msh(nodes, arrays.cells), directory / name);
        return directory / name;
      }

      /// The scene with its inputs in files.
      SceneParameters
      scene_with_files() const
      {
        SceneParameters scene
            = scene_of(write_pose(arrays.stretched, "stretched.msh"),
                       write_pose(arrays.sheared, "sheared.msh"), write_file("loaded", "3 8\n"));
        scene.mesh.file = directory / "mesh.msh";
        write_msh(make_msh(arrays.nodes, arrays.cells, arrays.material_ids, arrays.faces),
                  scene.mesh.file);
        return scene;
      }

      const Arrays arrays;
    };

    TEST_F(InputsTest, ArraysGiveTheBytesOfFiles)
    {
      const SceneParameters with_files = scene_with_files();
      Problem               by_files(with_files, read_inputs(with_files));
      Inputs                inputs;
      inputs.mesh  = make_msh(arrays.nodes, arrays.cells, arrays.material_ids, arrays.faces);
      inputs.poses = { { "stretched", arrays.stretched }, { "sheared", arrays.sheared } };
      inputs.nodes = { { "loaded", arrays.loaded } };
      Problem by_arrays(scene_of("stretched", "sheared", "loaded"), std::move(inputs));

      const State a = solve(by_files), b = solve(by_arrays);
      EXPECT_TRUE(a.positions == b.positions);
      EXPECT_EQ(a.weights, b.weights);
      EXPECT_GT(a.weights[1], 0.5); // the handles lead to the first pose
      by_arrays.body.mesh.write_pose(by_arrays.body.mesh.get_nodes(), directory / "again.msh");
      EXPECT_EQ(read_msh(directory / "again.msh").nodes, arrays.nodes);
    }

    TEST_F(InputsTest, TextNamesArraysAsItSays)
    {
      Inputs inputs;
      inputs.mesh = make_msh(arrays.nodes, arrays.cells, arrays.material_ids, arrays.faces);
      inputs.poses["a pose"] = arrays.sheared;
      const SceneFile scene("", "set Scene = dynamic\nsubsection Initial\nset Pose = a pose\nend\n",
                            std::vector<std::string>());
      const Problem   problem(scene.get_parameters(), inputs);
      for (unsigned int node = 0; node < arrays.nodes.size(); ++node)
        EXPECT_EQ(problem.state.positions[3 * node], arrays.sheared[node][0]);
    }

    TEST_F(InputsTest, WithoutImportanceNoExampleIsRead)
    {
      SceneParameters scene = scene_with_files();
      scene.examples.poses  = { directory / "absent.msh" };
      expect_contains(refusal([&] { read_inputs(scene); }), "absent.msh");
      scene.examples.importance = 0.;
      EXPECT_NO_THROW(read_inputs(scene));
    }

    TEST_F(InputsTest, AFileThatDoesNotFitIsNamedWithItsKey)
    {
      SceneParameters scene = scene_with_files();
      write_file("loaded", "3 999\n");
      expect_contains(refusal([&] { read_inputs(scene); }),
                      "Loads/push/Select: '999' in " + (directory / "loaded").string());
      write_file("loaded", "3\n");
      const MshFile other = generate_box({ { 4., 1., 1. } }, { { 3, 1, 1 } });
      write_msh(other, directory / "stretched.msh");
      expect_contains(refusal([&] { read_inputs(scene); }),
                      "Handles/right/Follow pose: " + (directory / "stretched.msh").string()
                          + " is no pose of " + scene.mesh.file + ": it has 16 nodes");
      MshFile large = read_msh(scene.mesh.file);
      for (auto &node : large.nodes)
        node *= 1000.;
      write_msh(large, directory / "stretched.msh");
      expect_contains(refusal([&] { read_inputs(scene); }),
                      "stretched.msh is 1000 times as large as the body. Write both in the same "
                      "unit of length.");
    }

    TEST_F(InputsTest, ArraysThatDoNotFitAreRefused)
    {
      expect_contains(refusal(
                          [&] {
                            make_msh(arrays.nodes, { { { 0, 1, 2, 99 } } });
                          }),
                      "has node 99");
      expect_contains(refusal(
                          [&] {
                            make_msh(arrays.nodes, arrays.cells, { 1, 2 });
                          }),
                      "but 2 material ids");
      const auto error_with = [&](const std::function<void(Inputs &)> &change)
      {
        Inputs inputs;
        inputs.mesh  = make_msh(arrays.nodes, arrays.cells, arrays.material_ids, arrays.faces);
        inputs.poses = { { "stretched", arrays.stretched }, { "sheared", arrays.sheared } };
        inputs.nodes = { { "loaded", arrays.loaded } };
        change(inputs);
        return refusal([&] { Problem(scene_of("stretched", "sheared", "loaded"), inputs); });
      };
      EXPECT_EQ(error_with([](Inputs &) {}), "no UserError");
      expect_contains(error_with([](Inputs &i) { i.poses.erase("sheared"); }),
                      "Examples/Poses: there is no pose 'sheared'");
      expect_contains(error_with([](Inputs &i) { i.poses["sheared"].pop_back(); }),
                      "has 19 nodes, the mesh 20");
      expect_contains(error_with([](Inputs &i) { i.nodes.clear(); }),
                      "Loads/push/Select: there are no nodes 'loaded'");
      expect_contains(error_with([](Inputs &i) { i.nodes["loaded"] = { 20 }; }), "the index 20");
    }
  } // namespace
} // namespace Exemplar::Testing
