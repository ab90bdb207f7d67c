// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cgal_search_h
#define exemplar_cgal_search_h

#include <CGAL/AABB_tree.h>
#include <CGAL/version.h>

#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif

namespace Exemplar
{
  // An AABB tree of triangles; CGAL 6 has renamed its traits and primitive.
#if CGAL_VERSION_MAJOR >= 6
  template <class Kernel, class Iterator>
  using TriangleSearch = CGAL::AABB_tree<
      CGAL::AABB_traits_3<Kernel, CGAL::AABB_triangle_primitive_3<Kernel, Iterator>>>;
#else
  template <class Kernel, class Iterator>
  using TriangleSearch
      = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>>;
#endif
} // namespace Exemplar

#endif
