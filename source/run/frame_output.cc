// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/finiteness.h>
#include <exemplar/run/frame_output.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    const FrameFormat &
    find_format(const std::string &name, const std::vector<FrameFormat> &formats)
    {
      std::string allowed;
      for (const FrameFormat &format : formats)
      {
        if (format.name == name)
          return format;
        allowed += (allowed.empty() ? "" : ", ") + format.name;
      }
      throw UserError("Output/Formats: there is no format '" + name + "'. Allowed: " + allowed
                      + ".");
    }
  } // namespace

  FrameOutput::FrameOutput(Problem                        &problem,
                           std::filesystem::path           directory,
                           const std::vector<FrameFormat> &formats)
      : problem(problem), directory(std::move(directory)), formats(formats),
        background(problem.parameters.solver.n_threads > 1)
  {
    const OutputParameters &output = problem.parameters.output;
    for (const std::string &name : output.formats)
      if (const FrameFormat &format = find_format(name, formats); output.every > 0)
        writers.emplace_back(&format,
                             format.make_writer({ problem.body.mesh, problem.surface.get() }));
  }

  bool
  FrameOutput::is_due(const unsigned int step) const
  {
    const unsigned int every = problem.parameters.output.every;
    return every > 0 && (step % every == 0 || step == problem.time_axis.n_steps());
  }

  void
  FrameOutput::write()
  {
    const State &state = problem.state;
    Frame        frame = {
             state.step,       state.time,
             state.positions,  state.positions,
             state.velocities, problem.potential.get_cells().cell_results(state.positions, state.weights)
    };
    frame.displacement -= problem.body.fe_space.rest_positions();
    if (const std::string what = what_is_not_finite(frame.cells); !what.empty())
      throw SolverFailure("The frame of step " + std::to_string(state.step) + " would hold " + what
                          + " that are not finite numbers. Take smaller steps, and look at what "
                            "handles, loads and Initial do.");
    background.submit(
        [this, frame = std::move(frame)]
        {
          for (const auto &[format, writer] : writers)
            writer->write(frame, directory / format->frame_name(frame.step));
        });
  }

  void
  FrameOutput::write_if_missing()
  {
    for (const auto &[format, writer] : writers)
      if (!std::filesystem::exists(directory / format->frame_name(problem.state.step)))
        return write();
  }

  void
  FrameOutput::drain()
  {
    background.drain();
  }

  void
  FrameOutput::write_animations() const
  {
    for (const auto &[format, writer] : writers)
      if (!format->animation.empty())
        writer->write_animation(written_frames(*format), directory / format->animation);
  }

  std::vector<WrittenFrame>
  FrameOutput::written_frames(const FrameFormat &format) const
  {
    std::vector<WrittenFrame> frames;
    // every step, as Output/Every may have changed at a resume
    for (unsigned int step = 0; step <= problem.state.step; ++step)
      if (const auto file = directory / format.frame_name(step); std::filesystem::exists(file))
        frames.push_back({ problem.time_axis.time(step), file });
    return frames;
  }

  void
  FrameOutput::remove(const unsigned int step) const
  {
    namespace fs = std::filesystem;
    for (const FrameFormat &format : formats)
      if (const fs::path file = directory / format.frame_name(step);
          fs::is_regular_file(fs::symlink_status(file)))
        fs::remove(file);
  }
} // namespace Exemplar
