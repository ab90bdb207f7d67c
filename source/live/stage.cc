// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/stage.h>

#include <exemplar/run/problem/step_interval.h>

namespace Exemplar::Live
{
  namespace
  {
    constexpr std::size_t  max_moments       = 20;
    constexpr unsigned int steps_until_saved = 600;

    CompleteScene
    for_threads(CompleteScene parameters, const unsigned int n_threads)
    {
      if (parameters.scene != SceneKind::dynamic)
        throw UserError(parameters.name
                        + ": only dynamic scenes are live. Add --set Scene=dynamic.");
      if (!parameters.session.empty())
        throw UserError(parameters.name + ": this is a recorded session. It is played by: exemplar "
                        + parameters.name
                        + ". To go on by hand, take the scene without "
                          "Session/File.");
      parameters.solver.n_threads = n_threads;
      return parameters;
    }
  } // namespace

  Stage::Stage(const SceneFile             &scene,
               const std::filesystem::path &record_to,
               const unsigned int           n_threads)
      : scene(scene), parameters(for_threads(scene.get_parameters(), n_threads)),
        step_size(parameters.time.step)
  {
    make_problem_anew(); // first, as a scene that is refused must leave an earlier recording
    if (!record_to.empty())
      recording.emplace(record_to, scene, step_size);
    done.emplace(recording ? recording->session_file() : std::filesystem::path());
  }

  void
  Stage::make_problem_anew()
  {
    player.reset();
    problem.reset(); // before the next, for its memory
    problem = make_problem(parameters);
    player  = std::make_unique<SessionPlayer>(*problem);
  }

  void
  Stage::act(const Session &events)
  {
    for (const SessionEvent &event : events)
    {
      player->apply(event);
      done->add(event);
    }
  }

  SolveReport
  Stage::advance()
  {
    const unsigned int next = problem->state.step + 1;
    const SolveReport  report
        = problem->advance({ next * step_size, step_size }); // as TimeAxis has it
    if (is_success(report.status) && next % steps_until_saved == 0)
      save();
    return report;
  }

  void
  Stage::forget()
  {
    act({ { problem->state.step + 1, "forget", "", {}, {} } });
  }

  void
  Stage::keep_moment()
  {
    if (moments.size() == max_moments)
      moments.erase(moments.begin());
    moments.push_back({ problem->state, StoredBytes(problem->solver_memory()), done->size() });
  }

  bool
  Stage::go_back()
  {
    if (moments.empty())
      return false;
    const Moment moment = std::move(moments.back());
    moments.pop_back();
    done->cut(moment.done);
    make_problem_anew();
    LastingEvents until_then;
    done->for_each([&](const SessionEvent &event) { until_then.add(event); });
    player->catch_up(until_then);
    problem->resume_from(moment.state, moment.solver_memory.get());
    save();
    return true;
  }

  void
  Stage::begin_anew()
  {
    done->cut(0);
    moments.clear();
    make_problem_anew();
    save();
  }

  void
  Stage::save()
  {
    if (!recording)
      return;
    done->flush(); // before the scene that names it
    recording->save_scene(problem->state.step);
  }
} // namespace Exemplar::Live
