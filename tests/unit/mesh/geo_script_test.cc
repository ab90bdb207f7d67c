// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/geo_text.h>

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
          make_geo_text(geo);
        }
        catch (const UserError &error)
        {
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
      expect_contains(refusal("Save 'x';"), "--allow-commands");
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
      write_file("part.stl", "solid SystemCall 'x'; facet");
      EXPECT_EQ(refusal("Merge 'part.stl';"), "");
      EXPECT_NE(refusal("Include 'part.stl';"), "");
      expect_contains(refusal("\nMerge 'absent.geo';"), "script.geo:2: ");
      for (const std::string &name :
           { std::string("script.geo"), "../" + directory.filename().string() + "/script.geo" })
        expect_contains(refusal("If (0)\nInclude '" + name + "';\nEndIf"), "includes itself");
      write_file("twice.geo", "Include 'twice_0.geo';");
      write_file("twice_14.geo", "");
      for (unsigned int i = 0; i < 14; ++i)
      {
        const std::string next = "Include 'twice_" + std::to_string(i + 1) + ".geo';\n";
        write_file("twice_" + std::to_string(i) + ".geo", next + next);
      }
      expect_contains(refusal("Include 'twice.geo';"), "too many inclusions");
    }

    TEST_F(GeoScriptTest, TheTextIsTheScriptsWithoutThemselves)
    {
      const auto geo
          = write_file("script.geo", "a = 1; // one\n\nb += .5e-3;Include \"sub/part.inc\"; "
                                     "c/**/=\n{0 : 2}; e = 1d;\n");
      std::filesystem::create_directory(directory / "sub");
      write_file("sub/part.inc", "/* part\n */ d = 'x;';Merge \"../part.any\";");
      write_file("part.any", "solid\nfacet");
      write_file("script.geo.opt", "Mesh.Optimize = 0;");
      const GeoText text = make_geo_text(geo);
      EXPECT_EQ(text.script, "a = 1;\nb += .5e-3;\nd = 'x;';Merge \"data_1.stl\";\nc =\n"
                             "{0 : 2}; e = 1 d;\nMesh.Optimize = 0;\n");
      ASSERT_EQ(text.data.size(), 1u);
      EXPECT_EQ(text.data.at("data_1.stl"), "solid\nfacet");
      EXPECT_EQ(text.with_origins("Error: '/x/script.geo', line 3: bad", "/x/script.geo"),
                "Error: '" + (directory / "sub/part.inc").string() + "', line 2: bad");
      EXPECT_EQ(text.with_origins("'/x/script.geo', line 99", "/x/script.geo"),
                "'/x/script.geo', line 99");
    }

    TEST_F(GeoScriptTest, TheDigestIsOfTheText)
    {
      const auto geo = write_file(
          "script.geo", "Include 'part.inc'; Merge 'part.stl'; a() = ListFromFile(\"list\");");
      write_file("part.inc", "a = 1;");
      write_file("part.stl", "solid facet");
      write_file("list", "1 2");
      for (const auto &[name, text] :
           { std::pair("part.inc", "a = 2;"), { "part.stl", "solid facet 2" }, { "list", "1 3" } })
      {
        const GeoText     before = make_geo_text(geo);
        const std::string last   = before.digest();
        write_file(name, text);
        EXPECT_EQ(before.digest(), last); // whatever becomes of the files
        EXPECT_NE(make_geo_text(geo).digest(), last) << name;
      }
      for (const std::string script :
           { "a() = ListFromFile(StrCat(\"l\", \"ist\"));", "Field[1].FileName = 'list';",
             "a = FileExists('list');", "s = GetEnv('HOME');" })
        expect_contains(refusal(script), "reads what exemplar does not know");
    }

    TEST_F(GeoScriptTest, DataAreKnownByTheirBytes)
    {
      for (const auto &[bytes, extension] :
           { std::pair<std::string, std::string>("solid x\nfacet", ".stl"),
             { "solid x; SystemCall 'x';", "" },
             { std::string(80, 'S') + std::string("\1\0\0\0", 4) + std::string(50, 'x'), ".stl" },
             { std::string(80, 'S') + std::string("\1\0\0\0", 4) + std::string(51, 'x'), "" },
             { "ISO-10303-21;", ".step" },
             { std::string(72, ' ') + "S      1\n" + std::string(80, ' '), ".iges" },
             { "DBRep_DrawableShape\n", ".brep" },
             { "$MeshFormat\n2.2 0 8", ".msh" },
             { "\n$MeshFormat\n", "" },
             { "ply\nformat", ".ply" },
             { "plyer", "" },
             { "# vtk DataFile Version 3", ".vtk" },
             { "    -1\n  2411", ".unv" },
             { "", "" } })
        EXPECT_EQ(merged_format(bytes), extension) << bytes;
    }
  } // namespace
} // namespace Exemplar::Testing
