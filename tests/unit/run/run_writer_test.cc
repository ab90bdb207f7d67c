// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output/run_writer.h>

#include "expect_contains.h"
#include "scene.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    /// What a format was asked to write.
    struct Written
    {
      std::vector<Frame>        frames;
      std::vector<WrittenFrame> animation;
    };

    class RecordingWriter : public FrameWriter
    {
    public:
      explicit RecordingWriter(Written &written) : written(written) {}

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        written.frames.push_back(frame);
        std::ofstream(file) << "a frame";
      }

      void
      write_animation(const std::vector<WrittenFrame> &frames,
                      const std::filesystem::path     &file) const override
      {
        written.animation = frames;
        std::ofstream(file) << "all frames";
      }

    private:
      Written &written;
    };

    class RunWriterTest : public InTemporaryDirectory
    {
    protected:
      RunWriterTest()
      {
        for (const std::string name : { "fake", "other" })
          formats.push_back({ name, "animation." + name, [this, name](const FrameSubject &) {
                               return std::make_unique<const RecordingWriter>(written[name]);
                             } });
      }

      /// Run a dynamic scene to its end, from the start or from its checkpoint; its positions
      /// by step.
      std::vector<Vector>
      run(const std::vector<std::string> &names,
          const std::vector<std::string> &overrides,
          const bool                      resumed = false)
      {
        const SceneFile scene("", "set Scene = dynamic\n" + bar + drag, overrides);
        SceneParameters parameters  = scene.get_parameters();
        parameters.output.directory = directory / "out";
        parameters.output.formats   = names;
        const auto problem          = make_problem(parameters);
        RunWriter  writer(*problem, scene, formats);
        resumed ? writer.resume() : writer.begin();
        std::vector<Vector> positions = { problem->state.positions };
        while (problem->state.step < problem->time_axis.n_steps())
        {
          writer.add_step(problem->advance());
          positions.push_back(problem->state.positions);
        }
        writer.finish("converged");
        return positions;
      }

      std::set<std::string>
      files_that_begin_with(const std::string &beginning) const
      {
        std::set<std::string> names;
        for (const auto &entry : std::filesystem::directory_iterator(directory / "out"))
          if (const std::string name = entry.path().filename(); name.rfind(beginning, 0) == 0)
            names.insert(name);
        return names;
      }

      std::map<std::string, Written> written; ///< by format
      std::vector<FrameFormat>       formats;
    };

    const std::vector<std::string> three_steps
        = { "Time/Step=0.25", "Time/End=0.75", "Output/Every=2" };

    TEST_F(RunWriterTest, AFormatIsGivenEachFrameAndThenAll)
    {
      const auto                      positions = run({ "fake" }, three_steps);
      const std::vector<Frame>       &frames    = written["fake"].frames;
      const std::vector<unsigned int> steps     = { 0, 2, 3 }; // the last one, too
      ASSERT_EQ(frames.size(), steps.size());
      ASSERT_EQ(written["fake"].animation.size(), steps.size());
      for (unsigned int i = 0; i < steps.size(); ++i)
      {
        EXPECT_EQ(frames[i].step, steps[i]);
        EXPECT_EQ(frames[i].time, 0.25 * steps[i]);
        EXPECT_TRUE(frames[i].positions == positions[steps[i]]);
        Vector rest = frames[i].positions;
        rest -= frames[i].displacement;
        EXPECT_LT(max_difference(rest, positions[0]), 1e-15);
        EXPECT_EQ(frames[i].velocities.size(), positions[0].size());
        EXPECT_EQ(frames[i].cells.det_F.size(), 24u);
        EXPECT_EQ(written["fake"].animation[i].time, frames[i].time);
        EXPECT_EQ(written["fake"].animation[i].file.filename(),
                  "frame_000" + std::to_string(steps[i]) + ".fake");
      }
      EXPECT_GT(frames[2].velocities.l2_norm(), 0.);
      EXPECT_TRUE(written["other"].frames.empty());
    }

    TEST_F(RunWriterTest, FormatsAreWrittenSideBySide)
    {
      run({ "other", "fake" }, three_steps);
      EXPECT_EQ(written["other"].frames.size(), 3u);
      EXPECT_EQ(files_that_begin_with("frame_0002"),
                (std::set<std::string>{ "frame_0002.fake", "frame_0002.other" }));
      EXPECT_EQ(files_that_begin_with("animation"),
                (std::set<std::string>{ "animation.fake", "animation.other" }));
    }

    TEST_F(RunWriterTest, ANewRunClearsFramesOfAllFormats)
    {
      run({ "fake" }, three_steps);
      for (const std::string name : { "frame_.fake", "frame_1.fake.old", "frame_2.foreign" })
        std::ofstream(directory / "out" / name) << "not ours";
      std::ofstream(directory / "out/frame_0001.other.tmp") << "half a frame";
      run({ "other" }, { "Time/Step=0.25", "Time/End=0.25", "Output/Every=0" });
      EXPECT_EQ(files_that_begin_with("frame_"),
                (std::set<std::string>{ "frame_.fake", "frame_1.fake.old", "frame_2.foreign" }));
      EXPECT_TRUE(files_that_begin_with("animation").empty());
      EXPECT_TRUE(written["other"].frames.empty());
    }

    TEST_F(RunWriterTest, AResumedRunDropsTheLastFrameIfItIsNoneOfTheLongerRun)
    {
      run({ "fake" }, three_steps);
      written.clear();
      run({ "fake" }, { "Time/Step=0.25", "Time/End=1.25", "Output/Every=2" }, true);
      ASSERT_EQ(written["fake"].frames.size(), 2u); // 4 and 5
      EXPECT_EQ(files_that_begin_with("frame_"),
                (std::set<std::string>{ "frame_0000.fake", "frame_0002.fake", "frame_0004.fake",
                                        "frame_0005.fake" }));
      EXPECT_EQ(written["fake"].animation.size(), 4u);
    }

    TEST_F(RunWriterTest, FramesAreKnownByTheirNamesAndSteps)
    {
      const FrameFormat &format = formats[0];
      for (const unsigned int step : { 0u, 7u, 9999u, 10000u, 123456789u })
        EXPECT_EQ(format.step_of(format.frame_name(step)), step);
      for (const std::string name :
           { "frame_1.fake", "frame_00001.fake", "frame_0001.other", "frame_.fake",
             "frame_1234567890.fake", "frame_0001.fake.tmp", "animation.fake" })
        EXPECT_FALSE(format.step_of(name)) << name;
    }

    TEST_F(RunWriterTest, WhatIsNoFileOfARunIsNamedAndNothingIsRemoved)
    {
      run({ "fake" }, three_steps);
      const auto refusal = [&](const std::string &name, const std::string &beginning)
      {
        formats[0].frame_beginning = beginning;
        RunDirectory out(directory / "out", formats);
        try
        {
          out.take_for_new_run({});
          return std::string("not refused");
        }
        catch (const UserError &error)
        {
          EXPECT_TRUE(std::filesystem::exists(directory / "out/checkpoint.bin")) << name;
          return std::string(error.what());
        }
      };
      expect_contains(refusal("frame_0000.fake", "THE FORMAT"),
                      "which was not written by exemplar");
      std::filesystem::create_directory(directory / "out/frame_0007.other");
      expect_contains(refusal("frame_0007.other", ""),
                      "holds frame_0007.other, which is a directory");
      std::filesystem::remove(directory / "out/frame_0007.other");
      EXPECT_EQ(refusal("", ""), "not refused");
    }

    TEST_F(RunWriterTest, AnUnknownFormatIsRefused)
    {
      try
      {
        run({ "fake", "wobble" }, three_steps);
        ADD_FAILURE() << "no UserError";
      }
      catch (const UserError &error)
      {
        expect_contains(error.what(), "there is no format 'wobble'. Allowed: fake, other.");
      }
      EXPECT_FALSE(std::filesystem::exists(directory / "out"));
    }
  } // namespace
} // namespace Exemplar::Testing
