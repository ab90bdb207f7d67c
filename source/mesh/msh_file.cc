// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/text_file.h>
#include <exemplar/mesh/msh_reader.h>
#include <exemplar/mesh/msh_scanner.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

// Format: https://gmsh.info/doc/texinfo/gmsh.html, "File formats".

namespace Exemplar
{
  namespace
  {
    /// Map from node numbers to indices. Nearly every file counts its nodes up from the first one,
    /// so that position is tried before searching.
    class NodeIndex
    {
    public:
      NodeIndex(const std::vector<std::size_t> &numbers, const MshScanner &scanner)
      {
        pairs.reserve(numbers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i)
          pairs.emplace_back(numbers[i], i);
        std::sort(pairs.begin(), pairs.end());
        for (std::size_t i = 1; i < pairs.size(); ++i)
          if (pairs[i].first == pairs[i - 1].first)
            scanner.fail("node number " + std::to_string(pairs[i].first)
                         + " appears twice. Every node needs its own number: save the mesh anew.");
      }

      /// Writes the index of `number`; false if there is no such node.
      bool
      find(const std::size_t number, std::size_t &index) const
      {
        if (pairs.empty())
          return false;
        const std::size_t guess = number - pairs.front().first;
        const auto        pair  = (guess < pairs.size() && pairs[guess].first == number)
                                      ? pairs.begin() + static_cast<std::ptrdiff_t>(guess)
                                      : std::lower_bound(pairs.begin(), pairs.end(),
                                                         std::make_pair(number, std::size_t(0)));
        if (pair == pairs.end() || pair->first != number)
          return false;
        index = pair->second;
        return true;
      }

    private:
      std::vector<std::pair<std::size_t, std::size_t>> pairs;
    };
  } // namespace

  MshFile
  MshReader::read()
  {
    if (in.at_end())
      in.fail("the file is empty. Save or copy the mesh again.");
    if (in.begin_section() != "MeshFormat")
      in.fail("a gmsh .msh file begins with $MeshFormat, this one does not. For other formats: "
              "gmsh FILE -save -format msh22 -o NEW.msh");
    read_format();
    in.end_section();
    while (!in.at_end())
      read_section(in.begin_section());
    for (const char *const name : { "Nodes", "Elements" })
      if (seen.count(name) == 0)
        in.fail(
            std::string("there is no section $") + name
            + ". The file is truncated or has no mesh: mesh in three dimensions and save anew.");
    resolve_node_numbers();
    if (version_4)
      resolve_entities();
    else
      merge_repeated_cells();
    return std::move(msh);
  }

  void
  MshReader::read_section(const std::string &name)
  {
    if (name == "PartitionedEntities" || name == "ParametricNodes")
      in.fail("the section is not supported. In gmsh save without partitions "
              "(Mesh.PartitionSplitMeshFiles) and parameters (Mesh.SaveParametric = 0).");
    const bool known = name == "PhysicalNames" || name == "Entities" || name == "Nodes"
                       || name == "Elements" || name == "SurfaceTies" || name == "NormalTips";
    const bool is_own = name == "SurfaceTies" || name == "NormalTips";
    if (!known || (name == "Entities" && !version_4) || (is_own && in.is_binary()))
      return in.skip_section();

    if (!seen.insert(name).second)
      in.fail("the section appears twice. Save the mesh anew.");
    if (version_4 && in.is_binary() && name != "PhysicalNames")
      in.end_line();
    if (name == "PhysicalNames")
      read_physical_names();
    else if (name == "Entities")
      read_entities();
    else if (name == "SurfaceTies")
      read_surface_ties();
    else if (name == "NormalTips")
      read_normal_tips();
    else if (name == "Nodes")
      version_4 ? read_nodes_4() : read_nodes_2();
    else
      version_4 ? read_elements_4() : read_elements_2();
    in.end_section();
  }

  void
  MshReader::read_format()
  {
    const std::string version(in.text_word());
    if (version != "2" && version != "2.0" && version != "2.1" && version != "2.2"
        && version != "4.1")
      in.fail("MSH version " + version
              + " is not supported (2.0 to 2.2 and 4.1 are). Convert it: "
                "gmsh FILE -save -format msh22 -o NEW.msh");
    version_4                = (version == "4.1");
    const int binary         = in.text_int();
    const int bytes_per_real = in.text_int();
    if ((binary != 0 && binary != 1) || bytes_per_real != sizeof(double))
      in.fail(fmt::format("the file type must be 0 or 1 and the data size 8, found {} and {}.",
                          binary, bytes_per_real));
    if (binary == 0)
      return;
    in.end_line();
    in.set_binary(true);
    if (in.read_int() != 1)
      in.fail("the binary numbers are in another machine's byte order. Save the mesh as ASCII "
              "(Mesh.Binary = 0).");
  }

  void
  MshReader::read_physical_names()
  {
    const std::size_t n_names = in.text_size();
    in.begin_count(n_names, "names");
    for (std::size_t i = 0; i < n_names; ++i, in.count())
    {
      const int dimension                           = in.text_int();
      const int tag                                 = checked_tag(in.text_int());
      msh.physical_names[std::pair(dimension, tag)] = in.text_quoted();
    }
  }

  /// Read ties, with node numbers, which resolve_node_numbers() replaces by indices.
  void
  MshReader::read_surface_ties()
  {
    const std::size_t n_ties = in.text_size();
    in.begin_count(n_ties, "ties");
    for (std::size_t i = 0; i < n_ties; ++i, in.count())
    {
      SurfaceTie tie;
      for (std::size_t &node : tie.nodes)
        node = in.text_size();
      double sum = 0.;
      for (double &share : tie.shares)
        sum += share = in.read_double();
      if (!(std::abs(sum - 1.) < 1e-3))
        in.fail(fmt::format("the shares of tie {} do not sum to 1. Make the mesh anew.", i + 1));
      msh.surface_ties.push_back(tie);
    }
  }

  void
  MshReader::read_normal_tips()
  {
    const std::size_t n_tips = in.text_size();
    in.begin_count(n_tips, "tips");
    for (std::size_t i = 0; i < n_tips; ++i, in.count())
    {
      dealii::Point<3> tip;
      for (unsigned int c = 0; c < 3; ++c)
        tip[c] = in.read_double();
      msh.normal_tips.push_back(tip);
    }
  }

  int
  MshReader::checked_tag(const int tag) const
  {
    if (tag == std::numeric_limits<int>::min())
      in.fail(fmt::format("a tag of {} is not allowed, as there is no such positive number. Give "
                          "the group another one.",
                          tag));
    return tag;
  }

  void
  MshReader::read_coordinates(const std::size_t number)
  {
    dealii::Point<3> point;
    for (unsigned int d = 0; d < 3; ++d)
    {
      point[d] = in.read_double();
      if (!std::isfinite(point[d]))
        in.fail(fmt::format("node {} has a coordinate that is no finite number. Repair the mesh.",
                            number));
    }
    msh.nodes.push_back(point);
    in.count();
  }

  /// Read an element's node numbers, which resolve_node_numbers() replaces by indices.
  void
  MshReader::read_element_nodes(MshElement &element, const unsigned int n_nodes)
  {
    element.nodes.resize(n_nodes);
    for (auto &node : element.nodes)
      node = version_4 ? in.read_size() : in.read_int_as_size();
    msh.elements.push_back(element);
    in.count();
  }

  const MshElementKind &
  MshReader::kind_of(const unsigned int type) const
  {
    const MshElementKind *const kind = find_msh_element_kind(type);
    if (kind == nullptr)
      in.fail(fmt::format(
          "element type {} is not known (1 to 31 are). Mesh with 4-node tetrahedra.", type));
    return *kind;
  }

  /// Begin to read items. Their announced number is not trusted until they have been read: reserve
  /// no more than the file can hold, at 8 bytes for the shortest line "1 0 0 0\n".
  void
  MshReader::begin_items(const std::size_t n_items, const std::string &what)
  {
    in.begin_count(n_items, what);
    const std::size_t n_reserved = std::min(n_items, in.n_bytes_left() / 8);
    if (what == "nodes")
    {
      msh.node_numbers.reserve(n_reserved);
      msh.nodes.reserve(n_reserved);
    }
    else
      msh.elements.reserve(n_reserved);
  }

  void
  MshReader::require_all(const std::size_t n_read, const std::size_t n_announced) const
  {
    if (n_read != n_announced)
      in.fail(fmt::format(
          "the blocks hold {}, which is not the number announced. Save the mesh anew.", n_read));
  }

  void
  MshReader::resolve_node_numbers()
  {
    const NodeIndex index(msh.node_numbers, in);
    for (auto &element : msh.elements)
      for (auto &node : element.nodes)
      {
        const std::size_t number = node;
        if (!index.find(number, node))
          in.fail(fmt::format("element {} uses node {}, which $Nodes does not have. Save the mesh "
                              "anew, with all its nodes.",
                              element.number, number));
      }
    for (SurfaceTie &tie : msh.surface_ties)
      for (std::size_t &node : tie.nodes)
        if (const std::size_t number = node; !index.find(number, node))
          in.fail(fmt::format("a tie of the surface uses node {}, which $Nodes does not have. Make "
                              "the mesh anew.",
                              number));
  }

  const std::vector<int> &
  further_groups_of(const MshFile &msh, const MshElement &element)
  {
    static const std::vector<int> none;
    if (msh.further_groups.empty())
      return none;
    const auto dimension = static_cast<int>(find_msh_element_kind(element.type)->dimension);
    const auto found     = msh.further_groups.find({ dimension, element.elementary });
    return found == msh.further_groups.end() ? none : found->second;
  }

  bool
  is_in_group(const MshFile &msh, const MshElement &element, const unsigned int tag)
  {
    const auto is_it
        = [tag](const int one) { return static_cast<unsigned int>(std::abs(one)) == tag; };
    const std::vector<int> &further = further_groups_of(msh, element);
    return is_it(element.physical) || std::any_of(further.begin(), further.end(), is_it);
  }

  MshFile
  read_msh(const std::filesystem::path &file)
  {
    std::string reason;
    if (auto bytes = read_text_file(file, &reason))
      return read_msh_bytes(std::move(*bytes), file.string());
    throw UserError(file.string() + ": cannot be opened (" + reason
                    + "). Give the path of a gmsh .msh file." + missing_file_remedy(file));
  }

  MshFile
  read_msh_bytes(std::string bytes, const std::string &name)
  {
    return MshReader(std::move(bytes), name).read();
  }

  // Format: https://gmsh.info/doc/texinfo/gmsh.html, "File formats".
  // Sections of version 2.2.

  void
  MshReader::read_nodes_2()
  {
    const std::size_t n_nodes = in.text_size();
    if (in.is_binary())
      in.end_line();
    begin_items(n_nodes, "nodes");
    for (std::size_t i = 0; i < n_nodes; ++i)
    {
      msh.node_numbers.push_back(in.read_int_as_size());
      read_coordinates(msh.node_numbers.back());
    }
  }

  void
  MshReader::read_elements_2()
  {
    const std::size_t n_elements = in.text_size();
    if (in.is_binary())
      in.end_line();
    begin_items(n_elements, "elements");
    while (msh.elements.size() < n_elements)
    {
      MshElement element{};
      // In ASCII the number comes first; in binary a header serves many elements.
      if (!in.is_binary())
        element.number = in.read_int_as_size();
      element.type             = static_cast<unsigned int>(in.read_int_as_size());
      const std::size_t n_same = in.is_binary() ? in.read_int_as_size() : 1;
      const std::size_t n_tags = in.read_int_as_size();
      const auto       &kind   = kind_of(element.type);
      for (std::size_t i = 0; i < n_same; ++i)
      {
        if (in.is_binary())
          element.number = in.read_int_as_size();
        for (std::size_t k = 0; k < n_tags; ++k)
        {
          const int tag = checked_tag(in.read_int());
          if (k < 2) // the others are partitions
            (k == 0 ? element.physical : element.elementary) = tag;
        }
        read_element_nodes(element, kind.n_nodes);
      }
    }
    require_all(msh.elements.size(), n_elements);
  }

  // Format: https://gmsh.info/doc/texinfo/gmsh.html, "File formats".
  // Sections of version 4.1.

  void
  MshReader::read_entities()
  {
    std::array<std::size_t, 4> n_entities{};
    for (auto &n : n_entities)
      n = in.read_size();
    for (unsigned int dimension = 0; dimension <= 3; ++dimension)
    {
      in.begin_count(n_entities[dimension], fmt::format("entities of dimension {}", dimension));
      for (std::size_t i = 0; i < n_entities[dimension]; ++i, in.count())
      {
        const int tag = in.read_int();
        // A point's place, or the bounding box.
        for (unsigned int k = 0; k < (dimension == 0 ? 3U : 6U); ++k)
          in.read_double();
        const std::size_t n_physical = in.read_size();
        for (std::size_t k = 0; k < n_physical; ++k)
        {
          entity_physical[std::pair(dimension, tag)].push_back(checked_tag(in.read_int()));
        }
        const std::size_t n_bounding = (dimension == 0) ? 0 : in.read_size();
        for (std::size_t k = 0; k < n_bounding; ++k)
          in.read_int();
      }
    }
  }

  void
  MshReader::read_nodes_4()
  {
    const std::size_t n_blocks = in.read_size();
    const std::size_t n_nodes  = in.read_size();
    in.read_size(); // smallest and largest number
    in.read_size();
    begin_items(n_nodes, "nodes");
    for (std::size_t block = 0; block < n_blocks; ++block)
    {
      const std::size_t dimension = in.read_int_as_size();
      in.read_int(); // entity
      // Nodes on an entity may have parameters on it, too.
      const std::size_t n_parameters = (in.read_int() != 0) ? dimension : 0;
      const std::size_t first        = msh.node_numbers.size();
      const std::size_t n_in_block   = in.read_size();
      for (std::size_t i = 0; i < n_in_block; ++i)
        msh.node_numbers.push_back(in.read_size());
      for (std::size_t i = 0; i < n_in_block; ++i)
      {
        read_coordinates(msh.node_numbers[first + i]);
        for (std::size_t k = 0; k < n_parameters; ++k)
          in.read_double();
      }
    }
    require_all(msh.nodes.size(), n_nodes);
  }

  void
  MshReader::read_elements_4()
  {
    const std::size_t n_blocks   = in.read_size();
    const std::size_t n_elements = in.read_size();
    in.read_size(); // smallest and largest number
    in.read_size();
    begin_items(n_elements, "elements");
    for (std::size_t block = 0; block < n_blocks; ++block)
    {
      MshElement element{};
      in.read_int(); // the entity's dimension, which is the element's
      element.elementary           = in.read_int();
      element.type                 = static_cast<unsigned int>(in.read_int_as_size());
      const std::size_t n_in_block = in.read_size();
      const auto       &kind       = kind_of(element.type);
      for (std::size_t i = 0; i < n_in_block; ++i)
      {
        element.number = in.read_size();
        read_element_nodes(element, kind.n_nodes);
      }
    }
    require_all(msh.elements.size(), n_elements);
  }

  void
  MshReader::resolve_entities()
  {
    for (auto &element : msh.elements)
    {
      const unsigned int dimension = find_msh_element_kind(element.type)->dimension;
      const auto         entity    = entity_physical.find(std::pair(dimension, element.elementary));
      if (entity != entity_physical.end())
        element.physical = entity->second.front();
    }
    for (const auto &[entity, tags] : entity_physical)
      if (tags.size() > 1)
        msh.further_groups[{ static_cast<int>(entity.first), entity.second }].assign(
            tags.begin() + 1, tags.end());
  }

  void
  MshReader::merge_repeated_cells()
  {
    std::map<int, std::set<int>> tags; // of each volume
    for (const MshElement &element : msh.elements)
      if (element.type == MshElementType::tetrahedron
          || element.type == MshElementType::quadratic_tetrahedron)
        tags[element.elementary].insert(element.physical);
    for (const auto &[volume, of_volume] : tags)
      if (of_volume.size() > 1)
        merge_cells_of(volume, of_volume.size());
  }

  void
  MshReader::merge_cells_of(const int volume, const std::size_t n_groups)
  {
    std::map<std::vector<std::size_t>, std::vector<std::size_t>> copies; // by their nodes
    for (std::size_t i = 0; i < msh.elements.size(); ++i)
      if (const MshElement &element = msh.elements[i];
          element.elementary == volume && find_msh_element_kind(element.type)->dimension == 3)
        copies[element.nodes].push_back(i);
    const auto groups_of = [&](const std::vector<std::size_t> &cells)
    {
      std::vector<int> groups;
      for (const std::size_t cell : cells)
        groups.push_back(msh.elements[cell].physical);
      return groups;
    };
    const std::vector<int> groups = groups_of(copies.begin()->second);
    for (const auto &[nodes, cells] : copies)
      if (cells.size() != n_groups || groups_of(cells) != groups)
        return; // other programs have one entity with several groups
    std::vector<bool> keep(msh.elements.size(), true);
    for (const auto &[nodes, cells] : copies)
      for (std::size_t i = 1; i < cells.size(); ++i)
        keep[cells[i]] = false;
    std::size_t n = 0;
    for (std::size_t i = 0; i < keep.size(); ++i)
      if (keep[i])
      {
        if (n != i)
          msh.elements[n] = std::move(msh.elements[i]);
        ++n;
      }
    msh.elements.resize(n);
    msh.further_groups[{ 3, volume }].assign(groups.begin() + 1, groups.end());
  }
} // namespace Exemplar
