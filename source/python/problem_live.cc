// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/module_parts.h>

#include <fmt/core.h>

#include <algorithm>
#include <fstream>

namespace Exemplar::Python
{
  namespace py = pybind11;
  namespace fs = std::filesystem;

  namespace
  {
    /// Refuses a problem that the text of its scene does not describe, as the page begins from
    /// that.
    void
    require_scene_says_all(const HeldProblem &held)
    {
      const Problem &problem = held.get();
      if (problem.state.velocities.size() == 0)
        throw UserError("live(): only dynamic scenes are live, and this one is not. Make the "
                        "problem with Scene = dynamic.");
      if (!problem.parameters.session.empty())
        throw UserError("live(): this is a recorded session. Make the problem without "
                        "Session/File.");
      const std::string change = held.change_since_made();
      if (change == "step()" || change == "state")
        throw UserError("live(): the page begins where the scene does, but this problem has gone "
                        "on by "
                        + change + ". Call reset() before, or live() first.");
      if (!change.empty())
        throw UserError("live(): the page shows what the scene says, but this problem was changed "
                        "by "
                        + change
                        + ". Say it in the scene, or make the problem anew and change it on the "
                          "page.");
      held.get_inputs().require_unchanged("live()");
    }

    /// Places of the nodes in an example [m].
    std::vector<dealii::Point<3>>
    places_of(const Vector &pose)
    {
      std::vector<dealii::Point<3>> places(pose.size() / 3);
      for (unsigned int dof = 0; dof < pose.size(); ++dof)
        places[dof / 3][dof % 3] = pose[dof];
      return places;
    }

    /// A file written in place of an array of poses=.
    struct PoseFile
    {
      std::string name; ///< name of the array in the scene
      std::string file;
    };

    std::vector<PoseFile>
    write_poses(const Problem &problem, const SceneSource &source, const fs::path &directory)
    {
      std::vector<PoseFile> files;
      const ExamplePoses   &poses = problem.examples.poses;
      const unsigned int    first = problem.parameters.examples.has_rest_pose();
      for (unsigned int i = 0; i < source.n_poses; ++i)
      {
        const fs::path file = directory / fmt::format("session_pose_{}.msh", i);
        if (first + i < poses.size()) // else no example counts, and none is read
          problem.body.mesh.write_pose(places_of(poses.pose(first + i)), file);
        files.push_back(
            { (source.place.parent_path() / fmt::format("pose_{}", i)).string(), file.string() });
      }
      return files;
    }

    std::string
    joined(const std::vector<PoseFile> &files)
    {
      std::string text;
      for (const PoseFile &pose : files)
        text += (text.empty() ? "" : ", ") + pose.file;
      return text;
    }

    /// Write the scene of an unchanged problem for another program, and the files that replace
    /// arrays into a directory.
    void
    write_scene(const HeldProblem &held, const fs::path &file, const fs::path &directory)
    {
      const Problem           &problem = held.get();
      const SceneSource       &source  = held.get_source();
      std::vector<DeclaredKey> keys
          = SceneFile(source.place, source.text, source.assignments).get_keys();
      const auto value = [&keys](const std::string &path) -> std::string &
      {
        return std::find_if(keys.begin(), keys.end(),
                            [&](const DeclaredKey &key) { return key.path() == path; })
            ->value;
      };
      const auto poses = write_poses(problem, source, directory);
      for (DeclaredKey &key : keys) // such as those of handles that follow a pose
        for (const PoseFile &pose : poses)
          if (key.value == pose.name)
            key.value = pose.file;
      if (!poses.empty())
        value("Examples/Poses") = joined(poses);
      if (source.has_mesh)
      {
        const fs::path mesh = directory / "session_mesh.msh";
        problem.body.mesh.write_pose(problem.body.mesh.get_nodes(), mesh);
        if (value("Mesh/Surface").empty()) // which File then was, if that is a surface
          value("Mesh/Surface") = value("Mesh/File");
        value("Mesh/File")      = mesh.string();
        value("Mesh/Files")     = "";
        value("Mesh/Generator") = "none";
      }
      std::ofstream out(file, std::ios::binary);
      print_keys(out, keys, false);
      out.flush();
      if (!out)
        throw UserError("live(): " + file.string() + " cannot be written: is the disk full?");
    }
  } // namespace

  void
  add_live(ProblemClass &problem)
  {
    const auto live = [](const py::object &self, const py::object &port, const py::object &record)
    {
      require_scene_says_all(self.cast<const HeldProblem &>());
      const py::cpp_function write(
          [&self](const std::string &file, const std::string &directory)
          { write_scene(self.cast<const HeldProblem &>(), file, directory); });
      return py::module_::import("exemplar._live").attr("live")(write, port, record);
    };
    problem.def(
        "live", live, py::arg("port") = 0, py::arg("record") = py::none(),
        "live(port=0, record=None) -> Live\n\n"
        "Serve a page on which a copy of the body is pulled with the mouse, doc/live.md; print "
        "its\n"
        "address.\n\n"
        "A process of its own makes the body anew of what this problem was made of: the scene's\n"
        "keys, the files that it names, which must be as they were then, and the arrays of mesh=\n"
        "and poses=. It begins as the scene does. Nothing else is carried over, but refused: "
        "steps\n"
        "(call reset() first), and what was changed since by set_material(), set_motion(), "
        "hold(),\n"
        "add_term() and the like. Nothing comes back: this problem does not move, and what is\n"
        "pulled there can be had by record= alone.\n"
        "Returns an object with `address`, `log` (what the server has said) and close(), which is\n"
        "also called at the end of a with statement, and when nothing refers to the object.\n"
        "port: of 127.0.0.1; 0: one that is free. record: a directory in which the session is "
        "kept\n"
        "as a scene that plays it again; None: it is not. Raises UserError for a problem that is\n"
        "not dynamic, for one that is not as it was made, by what was changed, for files that\n"
        "have changed, and for what the program exemplar-live refuses.");
    refuse_other_arguments(problem, "live", "live is called as live(port=0, record=None).");
  }
} // namespace Exemplar::Python
