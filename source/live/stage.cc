// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/stage.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/run/output/weight_names.h>
#include <exemplar/run/problem/step_interval.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace Exemplar::Live
{
  namespace
  {
    constexpr std::size_t max_moments = 20;

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

    /// The greatest distance of nodes of a body from those of a pose that is moved rigidly to where the body is [m].
    double
    distance_from(const Vector &pose, const Vector &positions, const unsigned int n_nodes)
    {
      std::vector<dealii::Point<3>> from, to;
      for (unsigned int node = 0; node < n_nodes; ++node)
      {
        from.emplace_back(pose[3 * node], pose[3 * node + 1], pose[3 * node + 2]);
        to.emplace_back(positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]);
      }
      const RigidMotion motion  = best_rigid_motion(from, to);
      double            largest = 0.;
      for (unsigned int node = 0; node < n_nodes; ++node)
        largest = std::max(largest, motion(from[node]).distance(to[node]));
      return largest;
    }

    /// Throws UserError for a body that is nearly as at rest or as in an example: two examples that are alike share
    /// one weight as rounding decides.
    void
    refuse_what_is_there(const Problem &problem)
    {
      constexpr double    least    = 0.01; // of the diameter
      const double        diameter = problem.body.mesh.diameter();
      const ExamplePoses &poses    = problem.examples.poses;
      const auto          check    = [&](const Vector &pose, const std::string &name)
      {
        if (distance_from(pose, problem.state.positions, problem.body.mesh.n_nodes())
            < least * diameter)
          throw UserError("the body is hardly away from " + name
                          + ": all of it is within 1 % of its size from there. Pull it farther, or "
                            "hold it with pins.");
      };
      check(problem.body.fe_space.rest_positions(), "rest");
      for (unsigned int i = 0; i < poses.size(); ++i)
        check(poses.pose(i), "its example " + short_name_of_pose(poses, i));
    }

    /// Repeat an action that was possible before: if it is refused now, no body is left, and the
    /// server ends.
    template <typename Action>
    void
    end_if_refused(const Action &action)
    {
      try
      {
        action();
      }
      catch (const UserError &error)
      {
        throw std::runtime_error(error.what());
      }
      catch (const std::filesystem::filesystem_error &error) // for instance a moved recording
      {
        throw std::runtime_error(trouble_with_path(error) + ".");
      }
    }
  } // namespace

  StoredBytes::StoredBytes(const std::string &bytes) : file(std::tmpfile()), size(bytes.size())
  {
    if (!file || std::fwrite(bytes.data(), 1, size, file.get()) != size
        || std::fflush(file.get()) != 0)
      throw std::system_error(errno, std::generic_category(),
                              "A temporary file in " P_tmpdir
                              ", which keeps what Undo needs, cannot be written");
  }

  std::string
  StoredBytes::get() const
  {
    std::string bytes(size, '\0');
    std::rewind(file.get());
    if (std::fread(bytes.data(), 1, size, file.get()) != size)
      throw std::runtime_error("A temporary file in " P_tmpdir
                               ", which keeps what Undo needs, cannot be read.");
    return bytes;
  }

  Stage::Stage(const SceneFile             &scene,
               const std::filesystem::path &record_to,
               const unsigned int           n_threads)
      : parameters(for_threads(scene.get_parameters(), n_threads)), step_size(parameters.time.step)
  {
    if (!record_to.empty())
    {
      recording.emplace(record_to, step_size);
      kept.emplace(scene);
    }
    Inputs inputs    = read_inputs(parameters);
    contents         = inputs.mesh;
    BodyInputs given = make_body_inputs(parameters, std::move(inputs));
    fields           = given.fields;
    undivided        = given.undivided;
    make_problem_of(std::move(given));
  }

  std::filesystem::path
  Stage::begin()
  {
    std::filesystem::path earlier;
    if (recording)
    {
      recording->take();
      keys    = kept->copy_to(recording->get_directory(),
                              contents); // first, as it may fail
      earlier = recording->set_aside();
    }
    begin_recording();
    return earlier;
  }

  void
  Stage::begin_recording()
  {
    done.reset(); // it has an earlier file open
    done.emplace(recording ? recording->session_file() : std::filesystem::path());
    if (recording)
      recording->save_scene(keys);
  }

  void
  Stage::make_problem_of(BodyInputs body)
  {
    problem = make_problem(parameters, [&body](const CompleteScene &) { return std::move(body); });
    player  = std::make_unique<SessionPlayer>(*problem);
  }

  void
  Stage::make_problem_anew()
  {
    player.reset();
    problem.reset(); // frees its memory before the next is made
    end_if_refused(
        [this]
        {
          make_problem_of(
              { Mesh(contents, parameters.mesh.name(), parameters.mesh.scale, parameters.mesh.kind),
                fields, undivided });
        });
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
    if (is_success(report.status))
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
    if (recording)
      recording->set_n_steps(moment.state.step); // before later events are removed
    done->cut(moment.done);
    make_problem_anew();
    end_if_refused(
        [&]
        {
          LastingEvents until_then;
          done->for_each([&](const SessionEvent &event) { until_then.add(event); });
          player->catch_up(until_then);
          problem->resume_from(moment.state, moment.solver_memory.get());
        });
    return true;
  }

  void
  Stage::begin_anew()
  {
    moments.clear();
    if (recording && done->size() > 0)
    {
      done->flush();
      end_if_refused(
          [this]
          {
            recording->set_aside();
            begin_recording();
          });
    }
    else
    {
      if (recording)
        recording->set_n_steps(0);
      done->cut(0);
    }
    make_problem_anew();
  }

  std::string
  Stage::add_example()
  {
    std::vector<dealii::Point<3>> places;
    for (unsigned int node = 0; node < problem->body.mesh.n_nodes(); ++node)
    {
      const double *const x = problem->state.positions.begin() + 3 * node;
      places.emplace_back(x[0], x[1], x[2]);
      places.back() /= parameters.mesh.scale;
    }
    refuse_what_is_there(*problem);
    SceneParameters scene = parameters;
    const auto      n     = scene.examples.poses.size();
    std::string     name  = "by_hand_" + std::to_string(n + 1);
    if (recording)
      name = recording->save_pose(*problem).string();
    scene.examples.poses.push_back(name);
    CompleteScene next = for_threads(CompleteScene(std::move(scene)), parameters.solver.n_threads);
    if (!next.examples.in_use())
      throw UserError("examples do nothing while Examples/Importance is 0. Set it in the scene.");
    BodyFields of_next  = fields;
    of_next.poses[name] = std::move(places);
    Mesh            mesh(contents, next.mesh.name(), next.mesh.scale, next.mesh.kind);
    UndividedInputs apart = undivided;
    apart.weight_regions  = find_regions(next.examples, mesh, of_next);
    auto with_one_more    = make_problem(next,
                                         [&](const CompleteScene &) {
                                        return BodyInputs{ std::move(mesh), of_next, apart };
                                      });
    player.reset();
    problem    = std::move(with_one_more);
    parameters = std::move(next);
    fields     = std::move(of_next);
    undivided  = std::move(apart);
    moments.clear();
    if (recording)
    {
      done->flush();
      for (DeclaredKey &key : keys)
        if (key.path() == "Examples/Poses")
          key.value
              += (key.value.empty() ? "" : ", ") + std::filesystem::path(name).filename().string();
    }
    end_if_refused(
        [this]
        {
          if (recording)
            recording->set_aside();
          player = std::make_unique<SessionPlayer>(*problem);
          begin_recording();
        });
    return std::filesystem::path(name).stem().string();
  }

  void
  Stage::save()
  {
    if (!recording)
      return;
    done->flush(); // before the scene has the step that they lead to
    recording->set_n_steps(problem->state.step);
  }
} // namespace Exemplar::Live
