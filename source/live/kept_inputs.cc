// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/text_file.h>
#include <exemplar/live/kept_inputs.h>
#include <exemplar/run/scene/files_of_keys.h>

#include <algorithm>

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
} // namespace Exemplar::Live
