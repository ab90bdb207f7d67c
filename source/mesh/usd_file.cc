// SPDX-License-Identifier: GPL-3.0-or-later
// Format: OpenUSD, "USDA file format" and schema UsdGeomTetMesh.
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_builder.h>
#include <exemplar/mesh/mesh_text.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Takes the prim TetMesh from a text of USD.
    class UsdReader
    {
    public:
      UsdReader(std::string text, const std::string &name) : all(std::move(text)), name(name) {}

      MshFile
      read()
      {
        if (all.rfind("#usda", 0) != 0)
          fail(0, all.rfind("PXR-USDC", 0) == 0
                      ? "this is USD's binary form. Convert it to text: usdcat FILE -o NEW.usda."
                      : "a text of USD begins with #usda, this file does not.");
        blank_texts();
        find_tet_mesh();
        MeshBuilder builder([this](const std::string &message) { fail(begin, message); });
        builder.count_from_0();
        const auto points = tuples("point3f[] points", "point3d[] points", 3);
        for (const auto &point : points)
          builder.add_node({ point[0], point[1], point[2] });
        for (const auto &cell : tuples("int4[] tetVertexIndices", "", 4))
        {
          std::vector<long long> nodes;
          for (unsigned int v = 0; v < 4; ++v)
            nodes.push_back(static_cast<long long>(cell[v]));
          builder.add_element(MshElementType::tetrahedron, nodes, 0);
        }
        for (const std::string &note : notes)
          builder.note(name + ": " + note);
        return std::move(builder.msh);
      }

    private:
      [[noreturn]] void
      fail(const std::size_t at, const std::string &message) const
      {
        const auto line
            = 1
              + std::count(all.begin(),
                           all.begin() + static_cast<std::ptrdiff_t>(std::min(at, all.size())),
                           '\n');
        throw UserError(fmt::format("{}: line {}: {}", name, line, message));
      }

      /// Overwrite comments and quoted texts but the first line, so that braces in them do not count.
      void
      blank_texts()
      {
        for (std::size_t i = 1; i < all.size(); ++i)
          if (all[i] == '#')
            while (i < all.size() && all[i] != '\n')
              all[i++] = ' ';
          else if (all[i] == '"' || all[i] == '\'')
          {
            const char        quote   = all[i];
            const bool        is_long = all.compare(i, 3, std::string(3, quote)) == 0;
            const std::string end(is_long ? 3 : 1, quote);
            const std::size_t last = all.find(end, i + end.size());
            if (last == all.npos)
              fail(i,
                   "a quotation mark has no partner. The file is cut off: save or copy it again.");
            for (std::size_t k = i + 1; k < last; ++k)
              all[k] = all[k] == '\n' ? '\n' : '_';
            i = last + end.size() - 1;
          }
      }

      void
      find_tet_mesh()
      {
        std::size_t n = 0;
        for (std::size_t at = 0; (at = all.find("def TetMesh", at)) != all.npos; ++at, ++n)
          if (n == 0)
            begin = at;
        if (n == 0)
          fail(all.size(),
               "there is no 'def TetMesh', which alone has tetrahedra. Export the body as "
               ".obj and fill it: Mesh/File = FILE.obj.");
        if (n > 1)
          fail(begin,
               fmt::format("there are {} prims TetMesh; a mesh is one body. Export each to a "
                           "file of its own.",
                           n));
        if (const std::size_t at = all.find("xformOp"); at != all.npos)
          fail(at,
               "the scene has a transformation (xformOp), which is not applied. Export the body in "
               "world coordinates, without transformations.");
        begin = all.find('{', begin);
        end   = begin;
        for (int depth = 0; end < all.size(); ++end)
          if (all[end] == '{')
            ++depth;
          else if (all[end] == '}' && --depth == 0)
            break;
        if (end >= all.size())
          fail(all.size(),
               "the braces of TetMesh are not closed. The file is cut off: save or copy it "
               "again.");
        note_unit();
        if (all.find("def Mesh") != all.npos || all.find("def Points") != all.npos)
          notes.push_back("only the prim TetMesh is read.");
      }

      /// The list of an attribute, by either declaration; the first sample of several.
      std::vector<std::array<double, 4>>
      tuples(const std::string &declaration, const std::string &other, const unsigned int n)
      {
        const std::string attribute = declaration.substr(declaration.find(' ') + 1);
        std::size_t       at        = all.find(declaration, begin);
        if (at > end && !other.empty())
          at = all.find(other, begin);
        if (at > end)
          fail(begin, "TetMesh has no " + in_quotes(declaration) + ". Export the mesh again.");
        const std::size_t equals = all.find('=', at), open = all.find('[', equals);
        const std::size_t close = all.find(']', open);
        if (equals > end || open > end || close > end)
          fail(at,
               attribute + " has no list in brackets. The file is cut off: save or copy it again.");
        note_samples(at, equals, attribute);
        MeshText list(all.substr(open + 1, close - open - 1), name + ": " + attribute, ",()");
        std::vector<std::array<double, 4>> result;
        while (!list.at_end())
        {
          result.push_back({});
          for (unsigned int c = 0; c < n; ++c)
            result.back()[c] = n == 4 ? static_cast<double>(list.integer("an index"))
                                      : list.number("a coordinate");
        }
        return result;
      }

      void
      note_unit()
      {
        const std::size_t at = all.find("metersPerUnit"), equals = all.find('=', at);
        if (at == all.npos || equals == all.npos)
          return;
        const std::string text
            = trim(all.substr(equals + 1, all.find_first_of("\n)", equals) - equals - 1));
        if (const double unit = parse_number(text); std::isfinite(unit) && unit != 1.)
          notes.push_back("its unit is " + text + " m (metersPerUnit), which Mesh/Scale = " + text
                          + " makes metres of.");
      }

      void
      note_samples(const std::size_t at, const std::size_t equals, const std::string &attribute)
      {
        if (all.substr(at, equals - at).find("timeSamples") == std::string::npos)
          return;
        const std::size_t last = all.find('}', equals);
        if (std::count(all.begin() + static_cast<std::ptrdiff_t>(equals),
                       all.begin() + static_cast<std::ptrdiff_t>(std::min(last, all.size())), ':')
            > 1)
          notes.push_back("of the time samples of " + attribute + " the first is taken.");
      }

      std::string              all;
      const std::string        name;
      std::size_t              begin = 0, end = 0; ///< braces of TetMesh
      std::vector<std::string> notes;
    };
  } // namespace

  MshFile
  read_usd(std::string bytes, const std::string &name)
  {
    return UsdReader(std::move(bytes), name).read();
  }
} // namespace Exemplar
