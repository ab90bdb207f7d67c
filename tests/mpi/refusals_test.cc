// SPDX-License-Identifier: GPL-3.0-or-later
#include "../unit/temporary_directory.h"

#include <exemplar/base/errors.h>
#include <exemplar/run/inputs/shared_body.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/scene/scene_file.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <regex>
#include <vector>

// What is wrong with a scene is said by all processes in the same words, so that none waits for another
// and the program can say it once: tests/scenes/test_mpi_failures.py.
namespace Exemplar::Testing
{
  namespace
  {
    using Settings = std::vector<std::string>;

    const std::string held_bar = "set Scene = static\n"
                                 "subsection Mesh\n set Generator = box\n set Box size = 2, 1, 1\n"
                                 " set Box cells = 6, 3, 3\nend\n"
                                 "subsection Handles\n set Names = left\n"
                                 "subsection left\n set Select = boundary 1\nend\nend\n"
                                 "subsection Loads\n set Gravity = 0, 0, -1\nend\n";

    Settings
    of_mesh(const std::string &file)
    {
      return { "Mesh/Generator=none", "Mesh/Box size=1, 1, 1", "Mesh/Box cells=1, 1, 1",
               "Mesh/File=" + file };
    }

    /// Scenes of which each process has its own copy.
    class Refusals : public InTemporaryDirectory
    {
    protected:
      Refusals()
      {
        write_file("scene.prm", held_bar);
      }

      /// What this process is told; nothing if the problem is made.
      std::string
      refusal(const Settings &settings, const std::string &file = "scene.prm") const
      {
        try
        {
          const SceneFile scene(directory / file, settings);
          make_problem(scene.get_parameters(),
                       ReadBody([](const CompleteScene &parameters)
                                { return read_shared_body(parameters, MPI_COMM_WORLD); }));
          return "";
        }
        catch (const UserError &error)
        {
          return std::regex_replace(error.what(), std::regex("exemplar_test_[0-9]+"), "directory");
        }
      }

      /// All are told the same, with these words.
      void
      expect_refused(const Settings    &settings,
                     const std::string &words,
                     const std::string &file = "scene.prm") const
      {
        const std::string said = refusal(settings, file);
        EXPECT_NE(said.find(words), std::string::npos) << said;
        const auto of_all = dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, said);
        EXPECT_EQ(std::count(of_all.begin(), of_all.end(), said), static_cast<long>(of_all.size()));
      }
    };
  } // namespace

  TEST_F(Refusals, NoneWhereAllIsRight)
  {
    EXPECT_EQ(refusal({}), "");
  }

  TEST_F(Refusals, OfTheText)
  {
    write_file("wrong.prm", "set Scene = x\n");
    expect_refused({}, "wrong.prm:1: Scene", "wrong.prm");
    expect_refused({}, "nothing.prm: cannot be read", "nothing.prm");
    expect_refused({ "Mesh/Box cells=0, 1, 1" }, "Mesh/Box cells");
  }

  TEST_F(Refusals, OfMeshesAndPoses)
  {
    write_file("bad.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\nx\n");
    expect_refused(of_mesh("bad.msh"), "bad.msh");
    expect_refused(of_mesh("nothing.msh"), "nothing.msh");
    expect_refused({ "Examples/Poses=pose.msh" }, "pose.msh");
  }

  TEST_F(Refusals, OfAHandleThatSelectsNothing)
  {
    expect_refused({ "Handles/left/Select=boundary 77" }, "boundary id 77 has no faces");
    // of which one process alone may have nodes, or none
    expect_refused({ "Handles/left/Select=box 9 9 9 10 10 10" }, "Handles/left/Select");
  }

  TEST_F(Refusals, OfMoreProcessesThanCells)
  {
    const unsigned int n = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    write_file("one.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 "
                          "1 0\n4 0 0 1\n$EndNodes\n"
                          "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n");
    Settings settings = of_mesh("one.msh");
    settings.push_back("Handles/left/Select=box 0 0 0 0 1 1");
    if (n > 1)
      expect_refused(settings, "cells");
    else
      EXPECT_EQ(refusal(settings), "");
  }

  TEST_F(Refusals, OfWhatProcessesCannotShare)
  {
    for (const std::string setting : { "Solver/Linear solver=cholesky", "Output/Space error=true" })
    {
      expect_refused({ setting }, setting.substr(0, setting.find('=')));
      expect_refused({ setting }, "start without mpirun");
    }
  }
} // namespace Exemplar::Testing
