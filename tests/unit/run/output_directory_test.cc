// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output/output_directory.h>

#include "expect_contains.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <functional>

namespace Exemplar::Testing
{
  namespace
  {
    namespace fs = std::filesystem;

    class OutputDirectoryTest : public InTemporaryDirectory
    {
    protected:
      static std::string
      message_of(const std::function<void()> &action)
      {
        try
        {
          action();
        }
        catch (const UserError &error)
        {
          return error.what();
        }
        return "";
      }

      std::string
      refusal(const OwnFile &file, const std::vector<fs::path> &inputs = {}) const
      {
        return message_of([&] { require_replaceable(file, inputs, " Choose another."); });
      }
    };

    TEST_F(OutputDirectoryTest, IsMadeWhereItMayBe)
    {
      const fs::path deep = directory / "a" / "b";
      EXPECT_EQ(message_of([&] { require_writable(deep, ""); }), "");
      EXPECT_FALSE(fs::exists(deep)); // asking makes nothing
      make_directory(deep, "");
      EXPECT_TRUE(fs::is_directory(deep));
    }

    TEST_F(OutputDirectoryTest, IsRefusedWithTheRemedyWhereItMayNot)
    {
      const fs::path file = write_file("file", "x");
      for (const auto &[path, reason] :
           { std::pair<fs::path, const char *>{ file / "a", "is a file" },
             { "~/results", "~ is not replaced" },
             { "C:\\results", "is a path of Windows" } })
      {
        const fs::path    asked = path;
        const std::string message
            = message_of([&] { require_writable(asked, " Choose another."); });
        expect_contains(message, reason);
        expect_contains(message, " Choose another.");
      }
      expect_contains(message_of([&] { make_directory(file / "a", " Choose another."); }),
                      "cannot be made");
    }

    TEST_F(OutputDirectoryTest, AFileOfOthersIsNoneOfOurs)
    {
      EXPECT_EQ(objection_to(write_file("own", "step,time\n0,0\n"), "step,"), "");
      EXPECT_EQ(objection_to(write_file("cut", "st"), "step,"), ""); // when the machine failed
      EXPECT_EQ(objection_to(write_file("foreign", "a,b\n"), "step,"),
                "was not written by exemplar");
      fs::create_directory(directory / "folder");
      EXPECT_EQ(objection_to(directory / "folder", "step,"), "is a directory");
      fs::create_symlink(directory / "own", directory / "link");
      EXPECT_EQ(objection_to(directory / "link", "step,"), "is a link");
      fs::permissions(write_file("kept", "step,"), fs::perms::owner_read);
      EXPECT_EQ(objection_to(directory / "kept", "step,"), "is protected against writing");
    }

    TEST_F(OutputDirectoryTest, ALinkThatLeadsNowhereIsNotAbsent)
    {
      EXPECT_TRUE(is_absent(directory / "nothing"));
      fs::create_symlink(directory / "nothing", directory / "link");
      EXPECT_FALSE(is_absent(directory / "link"));
    }

    TEST_F(OutputDirectoryTest, ReplacesItsOwnWholeFilesAndNoInput)
    {
      const fs::path whole = write_file("own", "solid\nend\n"), cut = write_file("cut", "solid\n");
      EXPECT_EQ(refusal({ directory / "new", "solid" }), "");
      EXPECT_EQ(refusal({ whole, "solid", "end\n" }), "");
      expect_contains(refusal({ cut, "solid", "end\n" }), "was not written by exemplar");
      expect_contains(refusal({ whole, "solid", "end\n" }, { whole }), "but is the input");
      expect_contains(refusal({ whole, "mesh" }),
                      "Nothing has been changed. Move it away. Choose another.");
    }

    TEST_F(OutputDirectoryTest, IsKnownByItsFirstLine)
    {
      const fs::path file = write_file("run", "exemplar run\nmore\n");
      EXPECT_TRUE(begins_with(file, "exemplar run"));
      EXPECT_FALSE(begins_with(file, "exemplar"));
      EXPECT_FALSE(begins_with(directory / "nothing", "exemplar run"));
    }
  } // namespace
} // namespace Exemplar::Testing
