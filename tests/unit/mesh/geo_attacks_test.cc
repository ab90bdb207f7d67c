// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/geo_meshing.h>
#include <exemplar/mesh/geo_text.h>
#include <exemplar/mesh/mesh_generation.h>

#include "mesh/geo_attacks.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

namespace Exemplar::Testing
{
  namespace
  {
    namespace fs = std::filesystem;

    class GeoAttacksTest : public InTemporaryDirectory
    {
    protected:
      void
      SetUp() override
      {
        ::setenv("XDG_CACHE_HOME", "/proc/no/such", 1); // nothing is kept
        for (const std::string name : { "sub", "sub/deep", "run" })
          fs::create_directory(directory / name);
        const std::string evil = filled("SystemCall \"touch TRACE\";\n");
        for (const std::string name : { "evil.geo", "evil.obj", "evil.off", "evil.pos", "evil.msh",
                                        "evil", "both.geo", "with_options.stl.opt" })
          write_file(name, evil);
        write_file("evil.stl", "solid facet " + evil);
        write_file("evil_behind_blanks.msh", " $MeshFormat;\n" + evil);
        write_file("evil.geo.gz", "\x1f\x8b");
        write_file("nested.geo", "Include 'sub/middle.geo';\n");
        write_file("sub/middle.geo", "Include '../evil.geo';\n");
        // gmsh looks for the second of two inclusions on a line beside the first included file
        write_file("sub/empty.geo", "");
        write_file("sub/both.geo", evil);
        write_file("both.geo", "");
        // a path that is not what it looks like
        write_file("sub/link.geo", "");
        write_file("link.geo", evil);
        fs::create_directory_symlink(directory / "sub/deep", directory / "link_to_dir");
        fs::create_directory(directory / "other");
        fs::create_directory_symlink(directory / "other", directory / "sub/link_up");
        fs::create_symlink(directory / "evil.geo", directory / "sub/link_to_evil");
        write_file("with_options.stl",
                   "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 "
                   "0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n");
        write_file("half.geo", "SystemCall");
      }

      void
      TearDown() override
      {
        ::unsetenv("XDG_CACHE_HOME");
      }

      std::string
      filled(std::string text) const
      {
        for (const auto &[word, path] :
             { std::pair<std::string, std::string>("TRACE", directory / "trace"),
               { "DIR", directory } })
          for (std::size_t at; (at = text.find(word)) != std::string::npos;)
            text.replace(at, word.size(), path);
        return text;
      }

      std::set<fs::path>
      all_files() const
      {
        std::set<fs::path> files;
        for (const auto &entry : fs::recursive_directory_iterator(directory))
          files.insert(entry.path());
        return files;
      }

      /// Whether files are there that were not, which are removed.
      bool
      has_left_a_trace(const std::set<fs::path> &before) const
      {
        bool found = false;
        for (const fs::path &file : all_files())
          if (before.count(file) == 0)
            found = fs::remove_all(file) > 0 || found;
        return found;
      }

      /// gmsh reads a file itself; whatever it says of it.
      void
      let_gmsh_mesh(const fs::path &script, const Confinement confinement) const
      {
        CopyMessages messages{ 1 << 20 };
        try
        {
          mesh_script(script, directory / "run", confinement, { "gmsh", "", 60. }, messages);
        }
        catch (const SolverFailure &)
        {
        }
      }

      template <typename Action>
      void
      expect_no_trace(const Action &attempt) const
      {
        for (const GeoAttack &attack : geo_attacks())
        {
          const fs::path geo    = write_file("attack.geo", filled(attack.script));
          const auto     before = all_files();
          attempt(geo);
          EXPECT_FALSE(has_left_a_trace(before)) << attack.script;
        }
      }
    };

    TEST_F(GeoAttacksTest, NoneSucceeds)
    {
      expect_no_trace(
          [](const fs::path &geo)
          {
            try
            {
              mesh_geo_file(geo, false);
            }
            catch (const UserError &)
            {
            }
          });
    }

    TEST_F(GeoAttacksTest, NoneSucceedsAgainstTheKernelAlone)
    {
      expect_no_trace([this](const fs::path &geo) { let_gmsh_mesh(geo, Confinement::kernel); });
    }

    TEST_F(GeoAttacksTest, NoneSucceedsAgainstTheTextAlone)
    {
      expect_no_trace(
          [this](const fs::path &geo)
          {
            try
            {
              const GeoText  text   = make_geo_text(geo);
              const fs::path script = write_file("run/script.geo", text.script);
              for (const auto &[name, bytes] : text.data)
                write_file("run/" + name, bytes);
              let_gmsh_mesh(script, Confinement::none);
              for (const auto &[name, bytes] : text.data)
                fs::remove(directory / "run" / name);
              fs::remove(script);
            }
            catch (const UserError &)
            {
            }
          });
    }

    /// Or the tests above would say nothing.
    TEST_F(GeoAttacksTest, WithoutWallsTheySucceed)
    {
      unsigned int n_successes = 0;
      for (const GeoAttack &attack : geo_attacks())
      {
        const fs::path geo    = write_file("attack.geo", filled(attack.script));
        const auto     before = all_files();
        // a program in the background may end with gmsh, before it has begun
        for (unsigned int i = 0; i < (attack.works ? 50 : 1) && all_files() == before; ++i)
        {
          let_gmsh_mesh(geo, Confinement::none);
          for (unsigned int wait = 0; attack.works && wait < 10 && all_files() == before; ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        EXPECT_EQ(has_left_a_trace(before), attack.works) << attack.script;
        n_successes += attack.works ? 1 : 0;
      }
      EXPECT_GE(n_successes, 25u);
    }
  } // namespace
} // namespace Exemplar::Testing
