// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_triangle_strain_h
#define exemplar_triangle_strain_h

#include <exemplar/kernels/hinge_angle.h>
#include <exemplar/kernels/membrane_strain.h>
#include <exemplar/kernels/vector_product.h>

#include <array>

// The strains of a triangle of a shell and its elasticity, in closed form. No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// What the strains of a shell are, see ShellStrains.
  enum class ShellKind
  {
    plate,
    hinges
  };

  /// The strains of a triangle [-]: membrane xx, yy, xy of U - I, then curvature xx, yy, xy times
  /// thickness/12^(1/2), in the triangle's own frame. With hinges they are the relative changes of length
  /// of the three edges and the changes of their angles, which TriangleShape::bending scales. A product of two
  /// lists counts the last one of each three twice, see shell_strain_order().
  constexpr unsigned int n_shell_strains = 6;

  template <typename Number>
  using ShellNumbers = std::array<Number, n_shell_strains>;

  /// T.b of membranes.
  template <typename Number>
  Number
  contract_membrane(const ShellNumbers<Number> &T, const ShellNumbers<Number> &b)
  {
    return T[0] * b[0] + T[1] * b[1] + Number(2.) * T[2] * b[2];
  }

  /// T.b of curvatures.
  template <typename Number>
  Number
  contract_bending(const ShellNumbers<Number> &T, const ShellNumbers<Number> &b)
  {
    return T[3] * b[3] + T[4] * b[4] + Number(2.) * T[5] * b[5];
  }

  /// T.b, in which the last one of each three counts twice.
  template <typename Number>
  Number
  contract(const ShellNumbers<Number> &T, const ShellNumbers<Number> &b)
  {
    return contract_membrane(T, b) + contract_bending(T, b);
  }

  /// The elasticity of a triangle in plane stress: lambda tr(a) I + 2 mu a of the membrane's part and
  /// alike of the curvature's [Pa]. With hinges each number has a stiffness of its own: E of lengths and
  /// E/(1 - nu^2) of angles. With that a plane of equilateral triangles has Young's modulus E and the flexural rigidity of
  /// a plate (Seung and Nelson 1988).
  template <typename Number>
  struct TriangleElasticity
  {
    Number    lambda = Number(0.), mu = Number(0.);
    ShellKind kind = ShellKind::plate;

    /// A solid with these constants of Lamé has it where it is free to change its thickness.
    static TriangleElasticity
    of_solid(const Number lambda, const Number mu, const ShellKind kind = ShellKind::plate)
    {
      return { 2. * lambda * mu / (lambda + 2. * mu), mu, kind };
    }

    /// T with T.b = a:C:b.
    ShellNumbers<Number>
    stress(const ShellNumbers<Number> &a) const
    {
      const Number half(0.5), two(2.);
      if (kind == ShellKind::hinges)
      {
        const Number angle  = lambda + two * mu; // E/(1 - nu^2)
        const Number length = two * two * mu * (lambda + mu) / angle;
        // the last ones count twice
        return { { length * a[0], length * a[1], half * length * a[2], angle * a[3], angle * a[4],
                   half * angle * a[5] } };
      }
      const Number membrane = lambda * (a[0] + a[1]), bending = lambda * (a[3] + a[4]),
                   shear = two * mu;
      return { { membrane + shear * a[0], membrane + shear * a[1], shear * a[2],
                 bending + shear * a[3], bending + shear * a[4], shear * a[5] } };
    }
  };

  /// A triangle at rest, in its own frame. Edge i runs from vertex i to vertex i + 1.
  template <typename Number>
  struct TriangleShape
  {
    std::array<std::array<Number, 2>, 3> gradients; ///< of the shape functions [1/m]

    /// What the turn [rad] of the normal at edge i adds to the three curvatures, which are scaled by
    /// thickness/12^(1/2). They are xx, yy, xy of a plate: l_i/A t_i t_i^T with the unit normal t_i of
    /// the edge. With hinges the i-th is l_i/(A + A') times the angle at edge i, beyond which A' is.
    std::array<std::array<Number, 3>, 3> bending;

    std::array<Number, 3> lengths; ///< of the edges [m]
  };

  /// An edge of a triangle as it is.
  template <typename Number>
  struct EdgeStretch
  {
    Vector3<Number> direction; ///< from its vertex i to the next one
    Number          length;    ///< [m]
  };

  /// The strains of a triangle whose vertices are at given places and whose normal turns at its edges, and their
  /// derivatives. The shape must outlive it.
  template <typename Number>
  class TriangleStrain
  {
  public:
    TriangleStrain(const ShellKind                       kind,
                   const TriangleShape<Number>          &shape,
                   const std::array<Vector3<Number>, 3> &places)
        : kind(kind), shape(shape), x(places),
          of_plane(column(shape, places, 0), column(shape, places, 1))
    {
    }

    const MembraneStrain<Number> &
    membrane() const
    {
      return of_plane;
    }

    /// The triangle as it is seen from edge i.
    HingeSide<Number>
    side(const int i) const
    {
      return { x[i], x[(i + 1) % 3], x[(i + 2) % 3] };
    }

    /// Edge i.
    EdgeStretch<Number>
    stretch(const int i) const
    {
      const Vector3<Number> edge   = difference(x[(i + 1) % 3], x[i]);
      const Number          length = norm(edge);
      return { times(Number(1.) / length, edge), length };
    }

    /// With these turns of the normal at the edges [rad].
    ShellNumbers<Number>
    strain(const std::array<Number, 3> &turns) const
    {
      ShellNumbers<Number> result;
      if (kind == ShellKind::hinges)
        for (int i = 0; i < 3; ++i)
          result[i] = stretch(i).length / shape.lengths[i] - Number(1.);
      else
        set_membrane(of_plane.strain(), result);
      set_bending(turns, result);
      return result;
    }

    /// How it changes with changes of the vertices' places and of the turns.
    ShellNumbers<Number>
    change(const std::array<Vector3<Number>, 3> &moved, const std::array<Number, 3> &turns) const
    {
      ShellNumbers<Number> result;
      if (kind == ShellKind::hinges)
        for (int i = 0; i < 3; ++i)
          result[i] = dot(stretch(i).direction, difference(moved[(i + 1) % 3], moved[i]))
                      / shape.lengths[i];
      else
        set_membrane(of_plane.change(column(shape, moved, 0), column(shape, moved, 1)).dU, result);
      set_bending(turns, result);
      return result;
    }

    /// The derivatives of T.strain of membranes by the places of the vertices.
    std::array<Vector3<Number>, 3>
    forces(const ShellNumbers<Number> &T) const
    {
      std::array<Vector3<Number>, 3> result;
      if (kind == ShellKind::hinges)
      {
        std::array<Vector3<Number>, 3> pull;
        for (int i = 0; i < 3; ++i)
          pull[i] = times((i == 2 ? Number(2.) : Number(1.)) * T[i] / shape.lengths[i],
                          stretch(i).direction);
        for (int i = 0; i < 3; ++i)
          result[i] = difference(pull[(i + 2) % 3], pull[i]);
        return result;
      }
      const auto P = of_plane.force({ { T[0], T[1], T[2] } });
      for (int i = 0; i < 3; ++i)
        result[i] = combine(shape.gradients[i][0], P[0], shape.gradients[i][1], P[1]);
      return result;
    }

    /// The derivatives of T.strain by the turns.
    std::array<Number, 3>
    moments(const ShellNumbers<Number> &T) const
    {
      std::array<Number, 3> result;
      for (int i = 0; i < 3; ++i)
      {
        const auto &b = shape.bending[i];
        result[i]     = T[3] * b[0] + T[4] * b[1] + Number(2.) * T[5] * b[2];
      }
      return result;
    }

  private:
    /// Column j of the gradient of a field of the vertices.
    static Vector3<Number>
    column(const TriangleShape<Number>          &shape,
           const std::array<Vector3<Number>, 3> &of_vertices,
           const int                             j)
    {
      return combine(shape.gradients[1][j], difference(of_vertices[1], of_vertices[0]),
                     shape.gradients[2][j], difference(of_vertices[2], of_vertices[0]));
    }

    static void
    set_membrane(const Symmetric2<Number> &of_membrane, ShellNumbers<Number> &strain)
    {
      for (int k = 0; k < 3; ++k)
        strain[k] = of_membrane[k];
    }

    void
    set_bending(const std::array<Number, 3> &turns, ShellNumbers<Number> &strain) const
    {
      for (int k = 0; k < 3; ++k)
        strain[3 + k] = turns[0] * shape.bending[0][k] + turns[1] * shape.bending[1][k]
                        + turns[2] * shape.bending[2][k];
    }

    const ShellKind                kind;
    const TriangleShape<Number>   &shape;
    std::array<Vector3<Number>, 3> x;
    MembraneStrain<Number>         of_plane;
  };
} // namespace Exemplar

#endif
