// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_meshes_h
#define exemplar_tests_meshes_h

#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh.h>

#include "temporary_directory.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <string>

// Small meshes, and what the tests of meshes ask of them.
namespace Exemplar::Testing
{
  inline constexpr unsigned int triangle    = MshElementType::triangle;
  inline constexpr unsigned int tetrahedron = MshElementType::tetrahedron;

  inline std::string
  error_of(const std::function<void()> &action)
  {
    try
    {
      action();
      return "";
    }
    catch (const UserError &error)
    {
      return error.what();
    }
  }

  inline std::string
  error_of(const MshFile &contents)
  {
    return error_of([&] { Mesh mesh(contents, "bar.msh"); });
  }

  /// Two positive tetrahedra on a common face 1, 2, 3. Node i has the number
  /// 10 + i; elements 101 (tag 5) and 102 (tag -6), triangle 50 (tag 7).
  inline MshFile
  two_tetrahedra()
  {
    MshFile msh;
    msh.node_numbers = { 10, 11, 12, 13, 14 };
    msh.nodes = { { 0., 0., 0. }, { 1., 0., 0. }, { 0., 1., 0. }, { 0., 0., 1. }, { 1., 1., 1. } };
    msh.elements = { { 50, triangle, 7, 1, { 0, 1, 2 } },
                     { 101, tetrahedron, 5, 1, { 0, 1, 2, 3 } },
                     { 102, tetrahedron, -6, 1, { 1, 2, 3, 4 } } };
    return msh;
  }

  inline void
  add_node(MshFile &msh, const dealii::Point<3> &point)
  {
    msh.node_numbers.push_back(10 + msh.nodes.size());
    msh.nodes.push_back(point);
  }

  inline double
  signed_volume(const Mesh &mesh, const std::array<unsigned int, 4> &cell)
  {
    const auto &x = mesh.get_nodes();
    return (x[cell[1]] - x[cell[0]])
           * dealii::cross_product_3d(x[cell[2]] - x[cell[0]], x[cell[3]] - x[cell[0]]) / 6.;
  }

  inline double
  total_volume(const Mesh &mesh)
  {
    double volume = 0.;
    for (const auto &cell : mesh.get_cells())
    {
      EXPECT_GT(signed_volume(mesh, cell), 0.);
      volume += signed_volume(mesh, cell);
    }
    return volume;
  }

  /// Area vector, outwards, of each boundary id.
  inline std::map<unsigned int, dealii::Tensor<1, 3>>
  areas(const Mesh &mesh)
  {
    std::map<unsigned int, dealii::Tensor<1, 3>> result;
    const auto                                  &x = mesh.get_nodes();
    for (const auto &face : mesh.get_boundary_faces())
      result[face.boundary_id] += 0.5
                                  * dealii::cross_product_3d(x[face.nodes[1]] - x[face.nodes[0]],
                                                             x[face.nodes[2]] - x[face.nodes[0]]);
    return result;
  }

  inline MeshParameters
  small_box()
  {
    MeshParameters parameters;
    parameters.generator = MeshGenerator::box;
    parameters.box_size  = { { 4., 1., 2. } };
    parameters.box_cells = { { 3, 1, 2 } };
    return parameters;
  }

  class MeshFilesTest : public Testing::InTemporaryDirectory
  {
  protected:
    std::filesystem::path
    write(const std::string &name, const std::string &text) const
    {
      return write_file(name, text);
    }
  };
} // namespace Exemplar::Testing

#endif
