// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/mesh/msh_file.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// Writer of lines of numbers, independent of the locale and fast: a pose of a million cells
    /// has 9 million of them.
    class LineWriter
    {
    public:
      explicit LineWriter(std::ostream &stream) : out(stream) {}

      template <typename Integer>
      void
      integer(const Integer value)
      {
        begin_number();
        end = std::to_chars(end, buffer.data() + buffer.size(), value).ptr;
      }

      /// Write a double with 17 significant digits, which reproduce it.
      void
      real(const double value)
      {
        begin_number();
        char *const limit = buffer.data() + buffer.size();
        end               = std::to_chars(end, limit, value, std::chars_format::general, 17).ptr;
      }

      /// Write a double with as many digits as reproduce it.
      void
      short_real(const double value)
      {
        begin_number();
        end = std::to_chars(end, buffer.data() + buffer.size(), value).ptr;
      }

      void
      end_line()
      {
        *end++        = '\n';
        at_line_start = true;
      }

      void
      flush()
      {
        out.write(buffer.data(), end - buffer.data());
        end = buffer.data();
      }

    private:
      void
      begin_number()
      {
        // No number has more than 24 characters.
        if (buffer.data() + buffer.size() - end < 32)
          flush();
        if (!at_line_start)
          *end++ = ' ';
        at_line_start = false;
      }

      std::ostream          &out;
      std::array<char, 4096> buffer;
      char                  *end           = buffer.data();
      bool                   at_line_start = true;
    };

    void
    write_physical_names(const MshFile &msh, std::ostream &out)
    {
      if (msh.physical_names.empty())
        return;
      out << fmt::format("$PhysicalNames\n{}\n", msh.physical_names.size());
      for (const auto &[key, name] : msh.physical_names)
        out << fmt::format("{} {} \"{}\"\n", key.first, key.second, name);
      out << "$EndPhysicalNames\n";
    }

    void
    write_nodes(const MshFile &msh, std::ostream &out)
    {
      out << fmt::format("$Nodes\n{}\n", msh.nodes.size());
      LineWriter line(out);
      for (std::size_t i = 0; i < msh.nodes.size(); ++i)
      {
        line.integer(msh.node_numbers[i]);
        for (unsigned int d = 0; d < 3; ++d)
          line.real(msh.nodes[i][d]);
        line.end_line();
      }
      line.flush();
      out << "$EndNodes\n";
    }

    /// Elements as their further groups repeat them, with numbers above all others.
    std::vector<MshElement>
    repeated_elements(const MshFile &msh)
    {
      std::vector<MshElement> repeated;
      if (msh.further_groups.empty())
        return repeated;
      std::size_t number = 0;
      for (const MshElement &element : msh.elements)
        number = std::max(number, element.number);
      for (const MshElement &element : msh.elements)
        for (const int tag : further_groups_of(msh, element))
        {
          repeated.push_back(element);
          repeated.back().number   = ++number;
          repeated.back().physical = tag;
        }
      return repeated;
    }

    void
    write_elements(const MshFile &msh, std::ostream &out)
    {
      const std::vector<MshElement> repeated = repeated_elements(msh);
      out << fmt::format("$Elements\n{}\n", msh.elements.size() + repeated.size());
      LineWriter line(out);
      for (const std::vector<MshElement> *const some : { &msh.elements, &repeated })
        for (const MshElement &element : *some)
        {
          line.integer(element.number);
          line.integer(element.type);
          line.integer(2); // tags
          line.integer(element.physical);
          line.integer(element.elementary);
          for (const std::size_t node : element.nodes)
            line.integer(msh.node_numbers[node]);
          line.end_line();
        }
      line.flush();
      out << "$EndElements\n";
    }

    void
    write_surface_ties(const MshFile &msh, std::ostream &out)
    {
      if (msh.surface_ties.empty())
        return;
      out << fmt::format("$SurfaceTies\n{}\n", msh.surface_ties.size());
      LineWriter line(out);
      for (const SurfaceTie &tie : msh.surface_ties)
      {
        for (const std::size_t node : tie.nodes)
          line.integer(msh.node_numbers[node]);
        for (const double share : tie.shares)
          line.short_real(share);
        line.end_line();
      }
      line.flush();
      out << "$EndSurfaceTies\n";
    }

    void
    write_normal_tips(const MshFile &msh, std::ostream &out)
    {
      if (msh.normal_tips.empty())
        return;
      out << fmt::format("$NormalTips\n{}\n", msh.normal_tips.size());
      LineWriter line(out);
      for (const dealii::Point<3> &tip : msh.normal_tips)
      {
        for (unsigned int c = 0; c < 3; ++c)
          line.real(tip[c]);
        line.end_line();
      }
      line.flush();
      out << "$EndNormalTips\n";
    }

    void
    write_to(std::ostream &out, const MshFile &msh)
    {
      out << msh_beginning;
      write_physical_names(msh, out);
      write_nodes(msh, out);
      write_elements(msh, out);
      write_surface_ties(msh, out);
      write_normal_tips(msh, out);
    }
  } // namespace

  const std::string msh_beginning = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";

  std::string
  msh_end(const std::string &comment)
  {
    return "$Comments\n" + comment + "\n$EndComments\n";
  }

  std::string
  msh_text(const MshFile &msh)
  {
    std::ostringstream out;
    write_to(out, msh);
    return out.str();
  }

  void
  write_msh(const MshFile &msh, const std::filesystem::path &file, const std::string &comment)
  {
    AtomicFile atomic_file(file);
    write_to(atomic_file.stream(), msh);
    if (!comment.empty())
      atomic_file.stream() << msh_end(comment);
    atomic_file.commit();
  }
} // namespace Exemplar
