// SPDX-License-Identifier: GPL-3.0-or-later
// Format: H. Si, TetGen's manual, section "File formats".
#include <exemplar/mesh/format_readers.h>
#include <exemplar/mesh/mesh_builder.h>
#include <exemplar/mesh/mesh_text.h>

#include <fmt/core.h>

#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// A file of TetGen: lines of words, of which # begins a comment.
    class TetgenText
    {
    public:
      TetgenText(std::string bytes, const std::string &name)
          : text(std::move(bytes), name, ",", '#')
      {
        if (text.at_end())
          text.fail("the file is empty. Save or copy the mesh again.");
      }

      /// The words of the next line that has some.
      const std::vector<std::string_view> &
      next_line(const std::string &what)
      {
        if (text.at_end())
          text.fail_at_end(what);
        std::string_view line = text.rest_of_line();
        words                 = words_of(line.substr(0, line.find('#')), ",");
        return words;
      }

      /// Fails unless this line has n words.
      void
      require(const std::size_t n, const std::string &what) const
      {
        if (words.size() != n)
          text.fail(
              fmt::format("{} should have {} numbers on its line, found {}. The first line of "
                          "the file says how many: save or copy the mesh again.",
                          what, n, words.size()));
      }

      /// Fails if there is more.
      void
      require_end(const std::string &what)
      {
        if (!text.at_end())
        {
          text.word("");
          text.fail("there is more behind the " + what
                    + " that the first line announces. Save or copy the mesh again.");
        }
      }

      std::size_t
      count(const std::size_t i, const std::string &what) const
      {
        if (i >= words.size())
          return 0;
        const long long n = text.integer_of(words[i], what);
        if (n < 0 || static_cast<std::size_t>(n) > text.n_bytes_left())
          text.fail(
              fmt::format("{} is {}, but the file has only {} bytes left. Save or copy the mesh "
                          "again.",
                          what, n, text.n_bytes_left()));
        return static_cast<std::size_t>(n);
      }

      MeshText                      text;
      std::vector<std::string_view> words;
    };

    void
    read_tetgen_nodes(TetgenText &file, MeshBuilder &builder)
    {
      file.next_line("the numbers of nodes");
      const std::size_t n         = file.count(0, "the number of nodes");
      const std::size_t dimension = file.count(1, "the dimension");
      if (dimension != 3)
        file.text.fail(
            fmt::format("the nodes have {} coordinates. Only bodies in space have a "
                        "volume: the first line is the number of nodes, 3, the number of "
                        "attributes and that of markers.",
                        dimension));
      const std::size_t n_words = 4 + file.count(2, "the number of attributes")
                                  + file.count(3, "the number of boundary markers");
      for (std::size_t i = 0; i < n; ++i)
      {
        const std::string what  = fmt::format("node {} of {}", i + 1, n);
        const auto       &words = file.next_line(what);
        file.require(n_words, what);
        dealii::Point<3> place;
        for (unsigned int d = 0; d < 3; ++d)
          place[d] = file.text.number_of(words[d + 1], what);
        const long long number = file.text.integer_of(words[0], what);
        if (i == 0 && number == 0)
          builder.count_from_0();
        if (i == 0 && number != 0 && number != 1)
          file.text.fail(
              fmt::format("the first node has the number {}. Nodes are counted from 0 or "
                          "from 1.",
                          number));
        builder.add_node(number, place);
      }
      file.require_end("nodes");
    }

    void
    read_tetgen_faces(TetgenText &file, MeshBuilder &builder)
    {
      file.next_line("the number of faces");
      const std::size_t n         = file.count(0, "the number of faces");
      const bool        is_marked = file.count(1, "the number of boundary markers") > 0;
      for (std::size_t i = 0; i < n; ++i)
      {
        const std::string what  = fmt::format("face {} of {}", i + 1, n);
        const auto       &words = file.next_line(what);
        file.text.integer_of(words[0], "the number of " + what);
        // after the marker stand the cells on both sides, and after three corners three middles
        if (words.size() < (is_marked ? 5U : 4U))
          file.require(is_marked ? 5 : 4, what);
        const long long mark = is_marked ? file.text.integer_of(words[4], what) : 0;
        if (!is_marked || mark == 0)
          continue; // a face between cells
        std::vector<long long> nodes;
        for (unsigned int v = 0; v < 3; ++v)
          nodes.push_back(file.text.integer_of(words[v + 1], what));
        builder.add_element(MshElementType::triangle, nodes,
                            builder.tag(std::abs(mark), "the marker of " + what));
      }
      file.require_end("faces");
    }

    void
    read_tetgen_cells(TetgenText &file, MeshBuilder &builder)
    {
      file.next_line("the number of tetrahedra");
      const std::size_t n       = file.count(0, "the number of tetrahedra");
      const std::size_t n_nodes = file.count(1, "the number of nodes of a tetrahedron");
      if (n_nodes != 4 && n_nodes != 10)
        file.text.fail(
            fmt::format("the cells have {} nodes each. Tetrahedra of 4 and of 10 nodes are "
                        "read: the first line is their number, 4 or 10, and the number of "
                        "attributes.",
                        n_nodes));
      const std::size_t n_attributes = file.count(2, "the number of attributes");
      for (std::size_t i = 0; i < n; ++i)
      {
        const std::string what  = fmt::format("tetrahedron {} of {}", i + 1, n);
        const auto       &words = file.next_line(what);
        file.require(1 + n_nodes + n_attributes, what);
        file.text.integer_of(words[0], "the number of " + what);
        std::vector<long long> nodes;
        for (std::size_t v = 0; v < n_nodes; ++v)
          nodes.push_back(file.text.integer_of(words[v + 1], what));
        // TetGen's order of the six middles: 2-3, 0-3, 0-1, 1-2, 1-3, 0-2
        if (n_nodes == 10)
          nodes = { nodes[0], nodes[1], nodes[2], nodes[3], nodes[6],
                    nodes[7], nodes[9], nodes[5], nodes[4], nodes[8] };
        const double region = n_attributes > 0 ? file.text.number_of(words[1 + n_nodes], what) : 0.;
        if (!(region >= 0. && region == std::floor(region) && region < 2e9))
          file.text.fail(
              fmt::format("the attribute of {} is {}. Attributes are taken as numbers of "
                          "regions, which are whole and from 0 on: number the regions "
                          "anew.",
                          what, region));
        builder.add_element(n_nodes == 4 ? MshElementType::tetrahedron
                                         : MshElementType::quadratic_tetrahedron,
                            nodes, static_cast<int>(region));
      }
      file.require_end("tetrahedra");
      if (n_attributes > 1)
        builder.note(file.text.get_name()
                     + ": of the attributes of cells the first is the region.");
    }
  } // namespace

  MshFile
  read_tetgen(std::string                  nodes,
              std::string                  cells,
              std::string                  faces,
              const std::filesystem::path &node_file)
  {
    const auto beside = [&](const std::string &extension)
    { return std::filesystem::path(node_file).replace_extension(extension).string(); };
    TetgenText node_text(std::move(nodes), beside(".node")),
        cell_text(std::move(cells), beside(".ele"));
    TetgenText *current = &node_text;
    MeshBuilder builder([&](const std::string &message) { current->text.fail(message); });
    read_tetgen_nodes(node_text, builder);
    if (!faces.empty())
    {
      TetgenText face_text(std::move(faces), beside(".face"));
      current = &face_text;
      read_tetgen_faces(face_text, builder);
    }
    current = &cell_text;
    read_tetgen_cells(cell_text, builder);
    return std::move(builder.msh);
  }
} // namespace Exemplar
