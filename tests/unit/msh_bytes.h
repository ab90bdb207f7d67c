// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_msh_bytes_h
#define exemplar_tests_msh_bytes_h

#include <exemplar/base/errors.h>
#include <exemplar/mesh/msh_file.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

// A mesh in the bytes of every .msh format.
namespace Exemplar::Testing
{
  /// A test that writes and reads .msh files.
  class MshTest : public InTemporaryDirectory
  {
  protected:
    std::filesystem::path
    write(const std::string &bytes, const std::string &name = "mesh.msh") const
    {
      return write_file(name, bytes);
    }

    MshFile
    read(const std::string &bytes) const
    {
      return read_msh(write(bytes));
    }

    /// The message of the UserError that reading gives, "" if there is none.
    std::string
    error_of(const std::string &bytes) const
    {
      try
      {
        read(bytes);
        return "";
      }
      catch (const UserError &error)
      {
        return error.what();
      }
    }
  };

  /// Two tetrahedra, a physical triangle, a line and a point; node numbers have
  /// gaps and no order.
  inline MshFile
  two_tetrahedra_with_gaps()
  {
    MshFile msh;
    msh.node_numbers = { 40, 7, 12, 100000, 3 };
    msh.nodes        = {
             { 0., 0., 0. }, { 1. / 3., 0., 0. }, { 0., 0.1, 0. }, { 0., 0., 1e-17 }, { -0., 2., 7e300 }
    };
    msh.elements       = { { 11, 15, 0, 5, { 0 } },
                           { 12, 1, 6, 3, { 0, 1 } },
                           { 5, 2, 8, 2, { 0, 1, 2 } },
                           { 21, 4, 9, 1, { 0, 1, 2, 3 } },
                           { 20, 4, 9, 1, { 1, 2, 3, 4 } } };
    msh.physical_names = { { { 2, 8 }, "left \"end\"" }, { { 3, 9 }, "" } };
    return msh;
  }

  inline bool
  same_element(const MshElement &a, const MshElement &b)
  {
    return a.number == b.number && a.type == b.type && a.physical == b.physical
           && a.elementary == b.elementary && a.nodes == b.nodes;
  }

  inline bool
  equal(const MshFile &a, const MshFile &b)
  {
    bool same = a.node_numbers == b.node_numbers && a.nodes.size() == b.nodes.size()
                && a.physical_names == b.physical_names
                && std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(),
                              b.elements.end(), same_element);
    for (std::size_t i = 0; same && i < a.nodes.size(); ++i)
      for (unsigned int d = 0; d < 3; ++d) // bitwise: -0. is not 0.
        same = same && std::memcmp(&a.nodes[i][d], &b.nodes[i][d], sizeof(double)) == 0;
    return same;
  }

  /// Numbers as text with blanks or as bytes.
  class Numbers
  {
  public:
    explicit Numbers(const bool as_binary) : binary(as_binary)
    {
      out.precision(17);
    }

    template <typename Number>
    Numbers &
    operator<<(const Number &value)
    {
      if (binary)
        out.write(reinterpret_cast<const char *>(&value), sizeof(Number));
      else
        out << value << ' ';
      return *this;
    }

    Numbers &
    line()
    {
      if (!binary)
        out << '\n';
      return *this;
    }

    std::string
    str() const
    {
      return out.str();
    }

  private:
    bool               binary;
    std::ostringstream out;
  };

  inline std::string
  section(const std::string &name, const std::string &body)
  {
    return "$" + name + "\n" + body + (body.empty() || body.back() != '\n' ? "\n" : "") + "$End"
           + name + "\n";
  }

  inline std::string
  header(const std::string &version, const bool binary)
  {
    const int one = 1;
    return section("MeshFormat",
                   version + (binary ? " 1 8\n" : " 0 8\n")
                       + (binary ? std::string(reinterpret_cast<const char *>(&one), 4) : ""))
           + section("PhysicalNames", "2\n2 8 \"left \"end\"\"\n3 9 \"\"\n")
           + section("Comments", "$Nodes are further down");
  }

  /// What gmsh writes as version 2.2, by its documentation.
  inline std::string
  version_2(const MshFile &msh, const bool binary)
  {
    Numbers nodes(binary), elements(binary);
    for (std::size_t i = 0; i < msh.nodes.size(); ++i)
      (nodes << static_cast<int>(msh.node_numbers[i]) << msh.nodes[i][0] << msh.nodes[i][1]
             << msh.nodes[i][2])
          .line();
    for (const auto &e : msh.elements)
    {
      const int number = static_cast<int>(e.number);
      const int type   = static_cast<int>(e.type);
      if (binary)
        elements << type << 1 << 3 << number;
      else
        elements << number << type << 3;
      elements << e.physical << e.elementary << 77; // a third tag, to be skipped
      for (const auto n : e.nodes)
        elements << static_cast<int>(msh.node_numbers[n]);
      elements.line();
    }
    return header("2.2", binary)
           + section("Nodes", std::to_string(msh.nodes.size()) + "\n" + nodes.str())
           + section("Elements", std::to_string(msh.elements.size()) + "\n" + elements.str());
  }

  inline std::string
  entities(const bool binary)
  {
    using size = std::size_t;
    Numbers n(binary);
    (n << size(1) << size(1) << size(1) << size(1)).line();
    (n << 5 << 0. << 0. << 0. << size(0)).line();
    const auto box = [&](const int tag) { n << tag << 0. << 0. << 0. << 1. << 1. << 1.; };
    box(3);
    (n << size(1) << 6 << size(2) << 5 << -5).line();
    box(2);
    (n << size(2) << 8 << 1 << size(1) << 3).line(); // two physical groups
    box(1);
    (n << size(1) << 9 << size(1) << 2).line();
    return section("Entities", n.str());
  }

  /// Version 4.1; the first two nodes in a block with parameters on a surface.
  inline std::string
  version_4(const MshFile &msh, const bool binary)
  {
    using size = std::size_t;
    Numbers nodes(binary), elements(binary);
    (nodes << size(2) << msh.nodes.size() << size(3) << size(100000)).line();
    for (const bool on_surface : { true, false })
    {
      const size begin = on_surface ? 0 : 2;
      const size end   = on_surface ? 2 : msh.nodes.size();
      (nodes << (on_surface ? 2 : 3) << 1 << (on_surface ? 1 : 0) << end - begin).line();
      for (size i = begin; i < end; ++i)
        (nodes << msh.node_numbers[i]).line();
      for (size i = begin; i < end; ++i)
      {
        nodes << msh.nodes[i][0] << msh.nodes[i][1] << msh.nodes[i][2];
        if (on_surface)
          nodes << 0.25 << 0.75;
        nodes.line();
      }
    }
    (elements << msh.elements.size() << msh.elements.size() << size(5) << size(21)).line();
    for (const auto &e : msh.elements)
    {
      const int dimension = (e.type == 15) ? 0 : (e.type == 4) ? 3 : static_cast<int>(e.type);
      (elements << dimension << e.elementary << static_cast<int>(e.type) << size(1)).line();
      elements << e.number;
      for (const auto n : e.nodes)
        elements << msh.node_numbers[n];
      elements.line();
    }
    return header("4.1", binary) + entities(binary) + section("Nodes", nodes.str())
           + section("Elements", elements.str());
  }

  /// The same mesh in all four formats.
  inline std::vector<std::string>
  all_formats()
  {
    const MshFile msh = two_tetrahedra_with_gaps();
    return { version_2(msh, false), version_2(msh, true), version_4(msh, false),
             version_4(msh, true) };
  }

  inline std::string
  replaced(std::string text, const std::string &what, const std::string &by)
  {
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
  }
} // namespace Exemplar::Testing

#endif
