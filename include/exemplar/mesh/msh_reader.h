// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_msh_reader_h
#define exemplar_msh_reader_h

#include <exemplar/mesh/msh_file.h>
#include <exemplar/mesh/msh_scanner.h>

#include <map>
#include <set>
#include <string>
#include <utility>

namespace Exemplar
{
  /// A single reading of a file, section by section.
  class MshReader
  {
  public:
    MshReader(std::string bytes, const std::string &name) : in(std::move(bytes), name) {}

    MshFile
    read();

  private:
    void
    read_section(const std::string &name);
    void
    read_format();
    void
    read_physical_names();
    void
    read_entities();
    void
    read_surface_ties();
    void
    read_normal_tips();
    void
    read_nodes_2();
    void
    read_nodes_4();
    void
    read_elements_2();
    void
    read_elements_4();

    /// Check a physical tag, which may be negative: refuses the int without a magnitude.
    int
    checked_tag(int tag) const;
    void
    read_coordinates(std::size_t number);
    void
    read_element_nodes(MshElement &element, unsigned int n_nodes);
    const MshElementKind &
    kind_of(unsigned int type) const;
    void
    begin_items(std::size_t n_items, const std::string &what);
    void
    require_all(std::size_t n_read, std::size_t n_announced) const;
    void
    resolve_entities();

    /// Version 2 repeats the tetrahedra of an entity for each of its further groups: keep one of each.
    void
    merge_repeated_cells();
    void
    merge_cells_of(int volume, std::size_t n_groups);
    void
    resolve_node_numbers();

    MshScanner            in;
    bool                  version_4 = false;
    std::set<std::string> seen;
    MshFile               msh;
    /// 4.1: (dimension, entity) -> physical tags
    std::map<std::pair<unsigned int, int>, std::vector<int>> entity_physical;
  };
} // namespace Exemplar

#endif
