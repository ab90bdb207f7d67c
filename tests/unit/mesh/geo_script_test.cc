// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/geo_script.h>

#include "expect_contains.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <utility>

namespace Exemplar::Testing
{
  namespace
  {
    class GeoScriptTest : public InTemporaryDirectory
    {
    protected:
      /// What is said of a script; empty if it is not refused.
      std::string
      refusal(const std::string &text) const
      {
        const auto geo = write_file("script.geo", text);
        try
        {
          check_geo(geo);
        }
        catch (const UserError &error)
        {
          expect_contains(error.what(), "--allow-commands");
          return error.what();
        }
        return "";
      }
    };

    TEST_F(GeoScriptTest, CommandsThatRunOrWriteAreRefused)
    {
      for (const std::string script : { "SystemCall \"touch x\";",
                                        "System 'touch x';",
                                        "NonBlockingSystemCall Str(\"x\");",
                                        "a = \"x\";\nSystemCall a;",
                                        "Point(1) = {0, 0, 0}; SystemCall\n\n\"x\";",
                                        "/* SystemCall */ SystemCall \"x\";",
                                        "// a \"\nSystemCall \"x\"; // \"",
                                        "1e5SystemCall \"x\";",
                                        "x = 0x;SystemCall 'x';",
                                        "Printf(\"a\") > \"file\";",
                                        "Printf(\"%g\", a[1], b(2)) >> \"file\";",
                                        "Printf (Sprintf(\"a\")) > Str(\"b\");",
                                        "Save \"x.msh\";",
                                        "Save View[0] \"x.pos\";",
                                        "Print \"x.png\";",
                                        "Open \"x.geo\";",
                                        "Plugin(Annotate).Run;",
                                        "OnelabRun(\"a\", \"b\");",
                                        "CreateDir \"x\";",
                                        "Field[1] = ExternalProcess;",
                                        "StringToName[\"SystemCall\"] \"x\";",
                                        "S2N(\"SystemCall\") \"x\";",
                                        "General.ErrorFileName = \"x\";",
                                        "Macro f\nSystemCall 'x';\nReturn\nCall f;",
                                        "If (0)\nSystemCall 'x';\nEndIf" })
        EXPECT_NE(refusal(script), "") << script;
      expect_contains(refusal("\n\nSave 'x';"), "script.geo:3: the command Save");
    }

    TEST_F(GeoScriptTest, WhatGmshMightReadOtherwiseIsRefused)
    {
      for (const std::string &script :
           { std::string("a = \"\n// \"; SystemCall 'x';"),
             std::string("If (0)\na = \"EndIf SystemCall 'x';\";\nEndIf"), std::string("a = 'open"),
             std::string("/* open"), "a = \"" + std::string(1100, 'x') + "\";" })
      {
        EXPECT_NE(refusal(script), "") << script;
      }
      EXPECT_NE(refusal(std::string("Point\0(1)", 9)), "");
      expect_contains(refusal("Merge StrCat(\"a\", \".geo\");"), "not a plain text");
      expect_contains(refusal("Include a;"), "not a plain text");
    }

    TEST_F(GeoScriptTest, HarmlessScriptsAreNot)
    {
      for (const std::string script :
           { "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 1, 1e-3, 1.};",
             "// SystemCall \"x\"; it's a comment\n/* Save \"x\"; */ Mesh.SaveAll = 1;",
             "Physical Volume(\"Save\", 1) = {1}; Physical Surface('System') = {2};",
             "Open = 1; Save = Open + 2; If (Open)\nPoint(1) = {0, 0, 0};\nEndIf",
             "Printf(\"a > b; %g\", a(1)); Print.Background = 1;",
             "Macro SystemCalls\nReturn\nCall SystemCalls;", "For i In {0:3}\nEndFor",
             "General.Terminal = 1;\r\nPoint(1) = {0, 0, 0};\r\n", "" })
        EXPECT_EQ(refusal(script), "") << script;
    }

    TEST_F(GeoScriptTest, IncludedFilesAreCheckedToo)
    {
      write_file("bad.inc", "SystemCall 'x';");
      expect_contains(refusal("Include \"bad.inc\";"), "bad.inc:1: the command SystemCall");
      expect_contains(refusal("Merge 'bad.inc';"), "bad.inc:1");
      write_file("middle.geo", "Include \"bad.inc\";");
      expect_contains(refusal("Include \"middle.geo\";"), "bad.inc:1");
      expect_contains(refusal("Include '" + (directory / "bad.inc").string() + "';"), "bad.inc:1");
      write_file("script.geo.opt", "Save 'x';");
      expect_contains(refusal(""), "script.geo.opt:1");
      std::filesystem::remove(directory / "script.geo.opt");
      // data are not read as commands
      write_file("part.stl", "solid SystemCall 'x';");
      EXPECT_EQ(refusal("Merge 'part.stl'; Include 'script.geo'; Merge 'absent.geo';"), "");
      EXPECT_NE(refusal("Include 'part.stl';"), "");
    }

    TEST_F(GeoScriptTest, TheDigestsAreOfAllFiles)
    {
      const auto geo = write_file("script.geo", "Include 'part.inc'; Merge 'part.stl';");
      write_file("part.inc", "a = 1;");
      write_file("part.stl", "solid");
      const GeoInputs before = check_geo(geo);
      EXPECT_TRUE(before.all_known);
      for (const auto &[name, text] :
           { std::pair("part.inc", "a = 2;"), { "part.stl", "solid 2" } })
      {
        const std::string last = check_geo(geo).digests;
        write_file(name, text);
        EXPECT_NE(check_geo(geo).digests, last) << name;
      }
      EXPECT_FALSE(check_geo(write_file("reader.geo", "a() = ListFromFile(\"x\");")).all_known);
    }
  } // namespace
} // namespace Exemplar::Testing
