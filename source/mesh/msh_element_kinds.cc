// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/msh_file.h>

#include <array>

namespace Exemplar
{
  namespace
  {
    /// Element kinds by gmsh's type, from 1 (https://gmsh.info/doc/texinfo/gmsh.html, "File
    /// formats").
    constexpr std::array<MshElementKind, 31> element_kinds{
      { { "2-node line", 1, 2 },          { "3-node triangle", 2, 3 },
        { "4-node quadrangle", 2, 4 },    { "4-node tetrahedron", 3, 4 },
        { "8-node hexahedron", 3, 8 },    { "6-node prism", 3, 6 },
        { "5-node pyramid", 3, 5 },       { "3-node line", 1, 3 },
        { "6-node triangle", 2, 6 },      { "9-node quadrangle", 2, 9 },
        { "10-node tetrahedron", 3, 10 }, { "27-node hexahedron", 3, 27 },
        { "18-node prism", 3, 18 },       { "14-node pyramid", 3, 14 },
        { "1-node point", 0, 1 },         { "8-node quadrangle", 2, 8 },
        { "20-node hexahedron", 3, 20 },  { "15-node prism", 3, 15 },
        { "13-node pyramid", 3, 13 },     { "9-node triangle", 2, 9 },
        { "10-node triangle", 2, 10 },    { "12-node triangle", 2, 12 },
        { "15-node triangle", 2, 15 },    { "15-node triangle", 2, 15 },
        { "21-node triangle", 2, 21 },    { "4-node line", 1, 4 },
        { "5-node line", 1, 5 },          { "6-node line", 1, 6 },
        { "20-node tetrahedron", 3, 20 }, { "35-node tetrahedron", 3, 35 },
        { "56-node tetrahedron", 3, 56 } }
    };
  } // namespace

  const MshElementKind *
  find_msh_element_kind(const unsigned int type)
  {
    return (type >= 1 && type <= element_kinds.size()) ? &element_kinds[type - 1] : nullptr;
  }
} // namespace Exemplar
