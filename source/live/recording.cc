// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/words.h>
#include <exemplar/live/recording.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/run/scene/files_of_keys.h>

#include <fmt/core.h>

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <sstream>
#include <system_error>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    /// Digest of the contents and names of files, without their directories.
    std::string
    digest_of(const std::vector<fs::path> &files)
    {
      std::string text;
      for (const fs::path &file : files)
        text += sha256(file) + " " + file.filename().string() + "\n";
      return sha256_of_text(text);
    }

    bool
    are_there(const std::vector<fs::path> &files)
    {
      return std::all_of(files.begin(), files.end(),
                         [](const fs::path &file) { return fs::exists(file); });
    }

    /// Whether the mesh comes from a .geo, which may include other files, and give another mesh in
    /// another version of gmsh: the mesh is kept instead.
    bool
    is_geo(const std::string &key, const std::string &name)
    {
      return key == "Mesh/File" && fs::path(name).extension() == ".geo";
    }

    void
    require_regular(const std::string &key, const std::vector<fs::path> &files)
    {
      for (const fs::path &file : files)
        if (!fs::is_regular_file(file))
          throw UserError(
              key + ": " + file.string()
              + " is no regular file, so it cannot be kept for a recording. Save it as a "
                "file, or leave out --record.");
    }

    /// The copies that the folder of a digest is to hold.
    std::vector<fs::path>
    copies_in(const fs::path &folder, const std::vector<fs::path> &files)
    {
      std::vector<fs::path> copies;
      for (const fs::path &file : files)
        copies.push_back(folder / file.filename());
      return copies;
    }

    /// Calls `fill` for a new folder, which is there whole or not at all.
    template <typename Fill>
    void
    make_folder(const fs::path &folder, const Fill &fill)
    {
      const fs::path  unfinished = folder.string() + ".tmp";
      std::error_code error;
      fs::remove_all(unfinished, error);
      fs::create_directories(unfinished, error);
      try
      {
        if (error)
          throw UserError(error.message());
        fill(unfinished);
        fs::rename(unfinished, folder);
      }
      catch (const std::exception &failure)
      {
        fs::remove_all(unfinished, error);
        fs::remove(folder.parent_path(), error); // if nothing else is in it
        throw UserError("--record: inputs of the scene cannot be copied to " + folder.string()
                        + ": " + failure.what());
      }
    }

    void
    copy(const std::vector<fs::path> &files, const std::string &digest, const fs::path &folder)
    {
      if (fs::is_directory(folder))
        return; // the folder of an earlier recording
      make_folder(folder,
                  [&](const fs::path &unfinished)
                  {
                    for (const fs::path &file : files)
                      fs::copy_file(file, unfinished / file.filename());
                    if (digest_of(copies_in(unfinished, files)) != digest)
                      throw UserError(
                          "a file has changed while it was read. Start again when it is "
                          "saved.");
                  });
    }

    std::string
    replaced(std::string text, const std::string &from, const std::string &to)
    {
      for (std::size_t i = 0; (i = text.find(from, i)) != std::string::npos; i += to.size())
        text.replace(i, from.size(), to);
      return text;
    }

    const std::string mark_of_recording
        = "# A session that exemplar live has recorded; it is played again by: exemplar ";

    const std::string remedy = " Give another directory by --record.";

    constexpr unsigned int greatest_of_all = 1000000000;

    /// Frame rate of a session when it is played [1/s]: fast enough to be seen as motion.
    constexpr double frame_rate = 30.;

    /// Width of the value of Time/End in characters, so that a longer one fits in its place.
    constexpr std::size_t width_of_end = 24;

    bool
    begins_with_bytes(const fs::path &file, const std::string &bytes)
    {
      return fs::is_regular_file(fs::symlink_status(file))
             && read_text_file(file).value_or("").compare(0, bytes.size(), bytes) == 0;
    }

    /// Whether a directory entry belongs to a recording that has hardly begun, or is a mesh, which
    /// stays.
    bool
    may_be_of_recording(const fs::directory_entry &entry)
    {
      const fs::path &path = entry.path();
      return path.extension() == ".msh" || path.filename() == "inputs"
             || (path.filename() == "session.txt"
                 && Exemplar::objection_to(path, head_of_session()).empty())
             || (path.filename() == "scene.prm.tmp"
                 && Exemplar::objection_to(path, mark_of_recording).empty());
    }

    /// Whether the directory is that of a recording, does not exist, or holds nothing else.
    bool
    is_ours(const fs::path &directory)
    {
      if (is_absent(directory))
        return true;
      return fs::is_directory(directory)
             && (begins_with_bytes(directory / "scene.prm", mark_of_recording)
                 || std::all_of(fs::directory_iterator(directory), fs::directory_iterator(),
                                may_be_of_recording));
    }

    /// The greatest number in names like BEGIN0012END in a directory; 0: there is none.
    unsigned int
    greatest_number(const fs::path &directory, const std::string &begin, const std::string &end)
    {
      unsigned int greatest = 0;
      for (const fs::directory_entry &entry : fs::directory_iterator(directory))
      {
        const std::string name = entry.path().filename().string();
        if (name.size() <= begin.size() + end.size() || name.compare(0, begin.size(), begin) != 0
            || !ends_with(name, end))
          continue;
        const auto number = decimal_number<unsigned int>(
            name.substr(begin.size(), name.size() - begin.size() - end.size()));
        if (number && *number < greatest_of_all) // the next number would overflow
          greatest = std::max(greatest, *number);
      }
      return greatest;
    }

    std::string
    first_line(const fs::path &scene)
    {
      return mark_of_recording + message_text(scene.string()) + "\n";
    }

    /// The text of a scene that plays session.txt, for another session.
    std::string
    for_session(std::string text, const fs::path &scene, const std::string &session)
    {
      const std::string before = "set File = session.txt\n";
      if (const auto place = text.find(before); place != std::string::npos)
        text.replace(place, before.size(), "set File = " + session + "\n");
      return first_line(scene) + text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
    }

    void
    write(const fs::path &file, const std::string &text)
    {
      AtomicFile out(file);
      out.stream() << text;
      out.commit_without_sync();
    }
  } // namespace

  KeptInputs::KeptInputs(const SceneFile &scene) : keys(scene.get_keys())
  {
    for (const DeclaredKey &key : keys)
      for (const std::string &name : file_names(key))
        if (const auto files = files_of_name(key, name); !name.empty() && are_there(files))
        {
          require_regular(key.path(), files);
          all.push_back({ key.path(), name, files, digest_of(files) });
        }
  }

  std::vector<DeclaredKey>
  KeptInputs::copy_to(const fs::path &directory, const MshFile &mesh) const
  {
    std::vector<Named> named = all; // longest names first, as they may contain others
    std::stable_sort(named.begin(), named.end(),
                     [](const Named &a, const Named &b) { return a.name.size() > b.name.size(); });
    std::vector<DeclaredKey> copied = keys;
    for (const Named &input : named)
    {
      const std::string text = is_geo(input.key, input.name) ? msh_text(mesh) : "";
      const fs::path    folder
          = fs::path("inputs") / (text.empty() ? input.digest : sha256_of_text(text)).substr(0, 16);
      fs::path name = fs::path(input.name).filename();
      if (text.empty())
        copy(input.files, input.digest, directory / folder);
      else
      {
        name.replace_extension(".msh");
        if (!fs::is_directory(directory / folder))
          make_folder(directory / folder,
                      [&](const fs::path &unfinished) { write_msh(mesh, unfinished / name); });
      }
      for (DeclaredKey &key : copied)
        if (key.path() == input.key)
          key.value = replaced(key.value, input.name, (folder / name).string());
    }
    return copied;
  }

  Recording::Recording(fs::path where, const double step_size)
      : directory(std::move(where)), step_size(step_size)
  {
    if (!is_ours(directory))
      throw UserError("--record " + directory.string()
                      + ": this is neither a directory of a recording nor one without other files "
                        "than meshes. Nothing has been changed."
                      + remedy);
    require_writable(directory, remedy);
    require_replaceable({ scene_file(), mark_of_recording }, {}, remedy);
    require_replaceable({ session_file(), head_of_session() }, {}, remedy);
  }

  void
  Recording::take()
  {
    make_directory(directory, remedy);
    lock.emplace(directory, "--record " + directory.string()
                                + ": another server records there. Nothing has been changed."
                                + remedy);
  }

  fs::path
  Recording::set_aside()
  {
    n_poses = std::max(n_poses, greatest_number(directory, "pose_", ".msh"));
    if (is_absent(session_file()))
      return {};
    if (fs::file_size(session_file()) <= head_of_session().size()) // nothing was done
    {
      fs::remove(session_file());
      return {};
    }
    const unsigned int number = 1
                                + std::max(greatest_number(directory, "session_", ".txt"),
                                           greatest_number(directory, "scene_", ".prm"));
    const std::string session = fmt::format("session_{:04}.txt", number);
    const fs::path    kept    = directory / fmt::format("scene_{:04}.prm", number);
    require_replaceable({ kept, mark_of_recording }, {}, remedy);
    if (const auto text = read_text_file(scene_file()))
      write(kept, for_session(*text, kept, session));
    fs::rename(session_file(), directory / session);
    return kept;
  }

  void
  Recording::save_scene(std::vector<DeclaredKey> keys)
  {
    const std::string end = std::string(width_of_end, '@');
    for (DeclaredKey &key : keys)
      if (key.path() == "Session/File")
        key.value = "session.txt";
      else if (key.path() == "Time/End")
        key.value = end;
      else if (key.path() == "Output/Directory")
        key.value = "output/session";
      else if (key.path() == "Output/Every" && key.value == key.default_value)
        key.value = fmt::format("{}", std::max(1L, std::lround(1. / (frame_rate * step_size))));
    std::ostringstream text;
    text << first_line(scene_file());
    print_keys(text, keys, false);
    place_of_end = text.str().find(end);
    require_replaceable({ scene_file(), mark_of_recording }, {}, remedy);
    write(scene_file(), text.str());
    scene = std::make_unique<Descriptor>(::open(scene_file().c_str(), O_WRONLY | O_CLOEXEC));
    set_n_steps(0);
  }

  void
  Recording::set_n_steps(const unsigned int n_steps)
  {
    const std::string end = fmt::format("{:<{}}", std::max(n_steps, 1U) * step_size, width_of_end);
    if (::pwrite(scene->number, end.data(), end.size(), static_cast<off_t>(place_of_end))
        != static_cast<ssize_t>(end.size()))
      throw std::runtime_error(scene_file().string() + " cannot be written: " + std::strerror(errno)
                               + ".");
  }

  fs::path
  Recording::save_pose(const Problem &problem)
  {
    if (!fs::is_directory(directory))
      throw UserError(directory.string() + " is not there any more.");
    n_poses = std::max(n_poses, greatest_number(directory, "pose_", ".msh"));
    const fs::path                file = directory / fmt::format("pose_{:04}.msh", ++n_poses);
    std::vector<dealii::Point<3>> places;
    const Vector                 &x = problem.state.positions;
    for (unsigned int node = 0; node < problem.body.mesh.n_nodes(); ++node)
      places.emplace_back(x[3 * node], x[3 * node + 1], x[3 * node + 2]);
    problem.body.mesh.write_pose(places, file);
    return file;
  }
} // namespace Exemplar::Live
