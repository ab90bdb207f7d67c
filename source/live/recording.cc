// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/recording.h>

#include <fmt/core.h>

#include <algorithm>
#include <fstream>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    const std::string mark_of_recording
        = "# A session that exemplar live has recorded; it is played again by: exemplar ";

    /// Whether the directory is of a recording, or not there, or holds nothing but meshes, which stay.
    bool
    is_ours(const fs::path &directory)
    {
      const auto is_mesh
          = [](const fs::directory_entry &entry) { return entry.path().extension() == ".msh"; };
      if (!fs::exists(directory))
        return true;
      if (!fs::is_directory(directory))
        return false;
      if (std::all_of(fs::directory_iterator(directory), fs::directory_iterator(), is_mesh))
        return true;
      std::ifstream scene(directory / "scene.prm");
      std::string   first;
      return std::getline(scene, first)
             && first.compare(0, mark_of_recording.size(), mark_of_recording) == 0;
    }
  } // namespace

  Recording::Recording(fs::path where, const SceneFile &scene, const double step_size)
      : directory(std::move(where)), scene(scene), step_size(step_size)
  {
    std::error_code error;
    if (!is_ours(directory))
      throw UserError("--record " + directory.string()
                      + ": this is neither a directory of a recording nor one without other files "
                        "than meshes. Nothing has "
                        "been changed. Give another one.");
    fs::create_directories(directory, error);
    if (error || !std::ofstream(session_file()))
      throw UserError("--record " + directory.string()
                      + ": this cannot be written. Give another directory.");
    while (fs::exists(directory / fmt::format("pose_{:04}.msh", n_poses + 1)))
      ++n_poses;
    save_scene(0);
  }

  void
  Recording::save_scene(const unsigned int n_steps)
  {
    std::vector<DeclaredKey> keys = scene.get_keys();
    for (DeclaredKey &key : keys)
      if (key.path() == "Session/File")
        key.value = "session.txt";
      else if (key.path() == "Time/End")
        key.value = fmt::format("{}", std::max(n_steps, 1U) * step_size);
      else if (key.path() == "Output/Directory")
        key.value = "output/session";
    const fs::path file = directory / "scene.prm", temporary = directory / "scene.prm.tmp";
    {
      std::ofstream out(temporary, std::ios::binary);
      out << mark_of_recording << file.string() << "\n";
      print_keys(out, keys, false);
      out.flush();
      if (!out)
        throw std::runtime_error(file.string() + " cannot be written: is the disk full?");
    }
    fs::rename(temporary, file);
  }

  fs::path
  Recording::save_pose(const Problem &problem)
  {
    const fs::path                file = directory / fmt::format("pose_{:04}.msh", ++n_poses);
    std::vector<dealii::Point<3>> places;
    const Vector                 &x = problem.state.positions;
    for (unsigned int node = 0; node < problem.body.mesh.n_nodes(); ++node)
      places.emplace_back(x[3 * node], x[3 * node + 1], x[3 * node + 2]);
    problem.body.mesh.write_pose(places, file);
    return file;
  }
} // namespace Exemplar::Live
