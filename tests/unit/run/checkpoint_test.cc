// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/sealed_file.h>
#include <exemplar/run/output/checkpoint.h>
#include <exemplar/run/output/resume_checks.h>

#include "expect_contains.h"
#include "scene.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

namespace Exemplar::Testing
{
  namespace
  {
    std::string
    bytes_of(const std::filesystem::path &file)
    {
      std::ifstream      in(file, std::ios::binary);
      std::ostringstream bytes;
      bytes << in.rdbuf();
      return bytes.str();
    }

    class CheckpointTest : public InTemporaryDirectory
    {
    protected:
      CheckpointTest()
          : scene("", "set Scene = dynamic\n" + bar + drag, std::vector<std::string>{}),
            problem(make_problem(scene.get_parameters())), file(directory / "checkpoint.bin")
      {
        problem->advance();
        checkpoint.parameters        = values_of(scene);
        checkpoint.state             = problem->state;
        checkpoint.solver_memory     = problem->solver_memory();
        checkpoint.statistics_digest = sha256_of_text("");
        save_checkpoint(checkpoint, file);
      }

      std::string
      refusal() const
      {
        try
        {
          const Checkpoint loaded = load_checkpoint(file);
          check_resumable(loaded, scene, {}, *problem, file);
        }
        catch (const UserError &error)
        {
          return error.what();
        }
        return "";
      }

      void
      expect_refused(const std::string &bytes, const std::string &what) const
      {
        write_file("checkpoint.bin", bytes);
        const std::string message = refusal();
        EXPECT_NE(message, "") << what;
        expect_contains(message, "checkpoint.bin");
        expect_contains(message, "without --resume");
      }

      const SceneFile                scene;
      const std::unique_ptr<Problem> problem;
      const std::filesystem::path    file;
      Checkpoint                     checkpoint;
    };

    TEST_F(CheckpointTest, AWholeOneIsReadBack)
    {
      EXPECT_EQ(refusal(), "");
      const Checkpoint found = load_checkpoint(file);
      EXPECT_TRUE(found.state == problem->state);
      State other   = problem->state;
      other.history = { 1., 2. };
      EXPECT_FALSE(found.state == other);
      EXPECT_EQ(found.solver_memory, checkpoint.solver_memory);
    }

    TEST_F(CheckpointTest, EveryFlippedBitIsNoticed)
    {
      const std::string whole = bytes_of(file);
      for (std::size_t i = 0; i < whole.size(); i += 1 + whole.size() / 500)
      {
        std::string flipped = whole;
        flipped[i]          = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
        expect_refused(flipped, "bit of byte " + std::to_string(i));
      }
    }

    TEST_F(CheckpointTest, OtherLengthsAreNoticed)
    {
      const std::string whole = bytes_of(file);
      for (const std::size_t size : { whole.size() - 1, whole.size() - 82, whole.size() / 2,
                                      std::size_t(10), std::size_t(1), std::size_t(0) })
        expect_refused(whole.substr(0, size), "first " + std::to_string(size) + " bytes");
      expect_refused(whole + '\n', "appended");
      expect_refused(whole + whole, "twice");
    }

    TEST_F(CheckpointTest, OtherVersionsAndFilesAreRefused)
    {
      std::string other = bytes_of(file);
      other             = other.substr(0, n_sealed_bytes(file));
      other[20]         = '4';
      write_file("checkpoint.bin", other);
      seal_file(file);
      expect_contains(refusal(), "no checkpoint of this version of exemplar");
      std::filesystem::remove(file);
      expect_contains(refusal(), "there is no checkpoint");
      std::filesystem::create_directory(file);
      expect_contains(refusal(), "without --resume");
    }

    TEST_F(CheckpointTest, AStateOfAnotherProblemIsRefused)
    {
      checkpoint.state.positions.reinit(12);
      save_checkpoint(checkpoint, file);
      expect_contains(refusal(), "it holds 12 numbers as positions, but the scene has");
      checkpoint.state               = problem->state;
      checkpoint.state.velocities[7] = std::numeric_limits<double>::infinity();
      save_checkpoint(checkpoint, file);
      expect_contains(refusal(), "velocities are not all finite");
    }
  } // namespace
} // namespace Exemplar::Testing
