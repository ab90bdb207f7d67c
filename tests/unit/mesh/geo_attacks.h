// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_geo_attacks_h
#define exemplar_geo_attacks_h

#include <gmsh.h>
#include <string>
#include <vector>

namespace Exemplar::Testing
{
  /// A .geo that wants to run a command or to write a file. TRACE stands for a path where there is
  /// nothing, DIR for the directory of the script.
  struct GeoAttack
  {
    const char *script;
    bool        works; ///< in gmsh without any wall: then there is something at TRACE
  };

  /// In gmsh 4.8.4, and no longer in 4.13.1.
  constexpr bool works_in_old_gmsh = GMSH_API_VERSION_MINOR < 13;

  /// Files that attacks take in are there: evil.* (see geo_attacks_test.cc) and link_to_dir.
  inline const std::vector<GeoAttack> &
  geo_attacks()
  {
    static const std::vector<GeoAttack> attacks{
      // commands
      { "SystemCall \"touch TRACE\";", true },
      { "System 'touch TRACE';", true },
      { "NonBlockingSystemCall \"touch TRACE\";", true },
      { "a = \"touch TRACE\"; SystemCall a;", false },
      { "SystemCall StrCat(\"touch \", \"TRACE\");", true },
      { "SystemCall\n\n\"touch TRACE\";", true },
      { "/* */SystemCall/* */\"touch TRACE\";", true },
      { "1e5SystemCall \"touch TRACE\";", false },
      { "Macro f\nSystemCall 'touch TRACE';\nReturn\nCall f;", true },
      { "If (1)\nSystemCall 'touch TRACE';\nEndIf", true },
      { "For i In {1:2}\nSystemCall Sprintf('touch TRACE_%g', i);\nEndFor\nSystemCall 'touch "
        "TRACE';",
        true },
      { "StringToName[\"SystemCall\"] \"touch TRACE\";", true },
      { "S2N(\"SystemCall\") \"touch TRACE\";", false },
      { "Parse \"SystemCall 'touch TRACE';\";", false },
      // strings, comments and skipped parts that may be read in two ways
      { "a = \"\n// \"; SystemCall 'touch TRACE';", false },
      { "If (0)\na = \"EndIf SystemCall 'touch TRACE';\";\nEndIf", works_in_old_gmsh },
      { "// a \"\nSystemCall \"touch TRACE\"; // \"", true },
      { "a = 'open\nSystemCall \"touch TRACE\";", false },
      { "// c\rSystemCall \"touch TRACE\";\n", false },
      { "/* open\nSystemCall \"touch TRACE\";", false },
      // files that gmsh writes
      { "Printf(\"x\") > \"TRACE\";", true },
      { "Printf(\"x\") >> \"TRACE\";", true },
      { "Printf(Sprintf(\"x\")) > Str(\"TRACE\");", true },
      { "Error(\"x\") > \"TRACE\";", false },
      { "Warning(\"x\") > \"TRACE\";", false },
      { "Point(1) = {0, 0, 0}; Mesh 1; Save \"TRACE.msh\";", false },
      { "Save 'TRACE.msh'; Save 'TRACE';", true },
      { "Print \"TRACE\";", false },
      { "CreateDir \"TRACE\";", true },
      { "General.LogFileName = \"TRACE\";", false },
      { "General.ErrorFileName = \"TRACE\"; Error(\"x\");", false },
      { "General.OptionsFileName = \"TRACE\"; General.SaveOptions = 1;", false },
      { "General.SessionFileName = \"TRACE\"; General.SaveSession = 1; Exit;", false },
      { "SetString(\"General.OptionsFileName\", \"TRACE\"); SetNumber(\"General.SaveOptions\", 1);",
        false },
      { "View \"v\" { SP(0, 0, 0){1}; }; Save View[0] \"TRACE\";", false },
      { "View \"v\" { SP(0, 0, 0){1}; }; SendToServer View[0] 'TRACE';", false },
      // programs by other names
      { "OnelabRun(\"a\", \"touch TRACE\");", false },
      { "Solver.Name0 = \"a\"; Solver.Executable0 = \"touch TRACE\"; OnelabRun(\"a\");", false },
      { "Box(1) = {0, 0, 0, 1, 1, 1}; Field[1] = ExternalProcess; Field[1].CommandLine = \"touch "
        "TRACE\"; Background Field = 1;",
        false },
      { "SetFactory(\"OpenCASCADE\"); Box(1) = {0, 0, 0, 1, 1, 1}; Field[1] = ExternalProcess; "
        "Field[1].CommandLine = \"touch TRACE\"; Background Field = 1;",
        false },
      { "View \"v\" { SP(0, 0, 0){1}; }; Plugin(Annotate).Text = \"x\"; Plugin(Annotate).Run; Save "
        "View[0] \"TRACE\";",
        false },
      { "View \"v\" { SP(0, 0, 0){1}; }; Plugin(MathEval).Expression0 = \"v0\"; "
        "Plugin(MathEval).Run; Save View[1] \"TRACE\";",
        false },
      // inclusions
      { "Include \"evil.geo\";", true },
      { "Include \"DIR/evil.geo\";", true },
      { "Include StrCat(\"evil\", \".geo\");", true },
      { "Merge \"evil.geo\";", true },
      { "Merge \"evil.obj\";", true },
      { "Merge \"evil.off\";", works_in_old_gmsh },
      { "Merge \"evil.pos\";", true },
      { "Merge \"evil.msh\";", true },
      { "Merge \"evil_behind_blanks.msh\";", true },
      { "Merge \"evil\";", true },
      { "Include \"evil.stl\";", false },
      { "Merge \"evil.geo.gz\";", false },
      { "MergeWithBoundingBox \"evil.geo\";", true },
      { "Open \"evil.geo\";", false },
      { "Include \"nested.geo\";", true },
      { "Macro f\nInclude \"evil.geo\";\nReturn\nCall f;", true },
      { "Include \"sub/empty.geo\"; Include \"both.geo\";", true },
      { "Merge \"sub/link.geo\";\nMerge \"sub/link_up/../link.geo\";\n", true },
      { "Merge \"sub/link_to_evil\";", true },
      { "Merge \"with_options.stl\";", true },
      { "Include \"half.geo\"; \"touch TRACE\";", false },
    };
    return attacks;
  }
} // namespace Exemplar::Testing

#endif
