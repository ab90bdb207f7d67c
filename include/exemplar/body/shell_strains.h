// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shell_strains_h
#define exemplar_shell_strains_h

#include <exemplar/body/shell_mesh.h>
#include <exemplar/kernels/hinge_angle.h>
#include <exemplar/kernels/membrane_strain.h>

#include <array>
#include <functional>
#include <vector>

namespace Exemplar
{
  /// The strains of a triangle [-]: membrane xx, yy, xy of U - I, then curvature xx, yy, xy times
  /// thickness/12^(1/2), in the triangle's own frame. With hinges they are the relative changes of length
  /// of the three edges and the changes of their angles, which ShellTriangle::bending scales. A product of two
  /// lists counts the last one of each three twice, see shell_strain_order().
  constexpr unsigned int n_shell_strains = 6;
  using ShellStrain                      = std::array<double, n_shell_strains>;

  /// TargetSpace::order for strains.
  inline std::vector<unsigned int>
  shell_strain_order()
  {
    return { 0, 2, 2, 1, 3, 5, 5, 4 };
  }

  /// The elasticity of a triangle in plane stress: lambda tr(a) I + 2 mu a of the membrane's part and
  /// alike of the curvature's [Pa]. With hinges each number has a stiffness of its own: E of lengths and
  /// E/(1 - nu^2) of angles. With that a plane of equilateral triangles has Young's modulus E and the flexural rigidity of
  /// a plate (Seung and Nelson 1988).
  struct ShellElasticity
  {
    double    lambda = 0., mu = 0.;
    ShellKind kind = ShellKind::plate;

    /// A solid with these constants of Lamé has it where it is free to change its thickness.
    static ShellElasticity
    of_solid(const double lambda, const double mu, const ShellKind kind = ShellKind::plate)
    {
      return { 2. * lambda * mu / (lambda + 2. * mu), mu, kind };
    }

    /// T with T.b = a:C:b.
    ShellStrain
    stress(const ShellStrain &a) const
    {
      if (kind == ShellKind::hinges)
      {
        const double angle  = lambda + 2. * mu; // E/(1 - nu^2)
        const double length = 4. * mu * (lambda + mu) / angle;
        // the last ones count twice
        return { { length * a[0], length * a[1], 0.5 * length * a[2], angle * a[3], angle * a[4],
                   0.5 * angle * a[5] } };
      }
      const double membrane = lambda * (a[0] + a[1]), bending = lambda * (a[3] + a[4]);
      return { { membrane + 2. * mu * a[0], membrane + 2. * mu * a[1], 2. * mu * a[2],
                 bending + 2. * mu * a[3], bending + 2. * mu * a[4], 2. * mu * a[5] } };
    }
  };

  /// T.b, in which the last one of each three counts twice.
  inline double
  contract(const ShellStrain &T, const ShellStrain &b)
  {
    return T[0] * b[0] + T[1] * b[1] + 2. * T[2] * b[2] + T[3] * b[3] + T[4] * b[4]
           + 2. * T[5] * b[5];
  }

  /// Four nodes of which HingeAngle is a strain.
  struct ShellHinge
  {
    std::array<unsigned int, 4> nodes;
    double                      rest;  ///< the angle at rest
    unsigned int                owner; ///< a triangle all of whose hinges' nodes include these
    unsigned int edge, kind; ///< 0: of its two triangles; 1, 2: of one of these and the director
  };

  /// How the turn of the normal at a triangle's edge follows from positions: of_hinge times the change of
  /// a hinge's angle, and of_slope times a slope.
  struct ShellTurn
  {
    int    hinge    = -1; ///< -1: none
    double of_hinge = 0.;
    int    slope    = -1; ///< degree of freedom; -1: none
    double of_slope = 0.; ///< [1/m]

    /// Whether it is by both: then with the turn of the normal in space as the unknown, instead of the slope, it depends on the
    /// triangle's own vertices alone, of which it has the whole angle. See UnknownShear.
    bool
    is_sheared() const
    {
      return hinge >= 0 && slope >= 0;
    }
  };

  /// An edge of a triangle as it is.
  struct ShellStretch
  {
    Vector3<double> direction; ///< from its vertex i to the next one
    double          length;    ///< [m]
  };

  /// The strains of a shell. Those of a plate are by Grinspun, Gingold, Reisman and Zorin (2006). The normal at the middle of
  /// an edge turns out of the bisector of its triangles. Degree of freedom 3 p of its slope node p is its length
  /// times that turn; but where the node is held, its place is that of the tip of the edge's director, which
  /// the normal follows. Hinges (Froehlich and Botsch 2011) have no slopes: their strains are lengths and
  /// angles, which is less for the eye, but not for a mesh that is refined: bending then depends on its pattern.
  class ShellStrains
  {
  public:
    /// With no slope node held. The mesh must outlive this.
    explicit ShellStrains(const ShellMesh &mesh);

    const ShellMesh &
    get_mesh() const
    {
      return mesh;
    }

    /// Let these slope nodes be held, by edge.
    void
    set_held(const std::vector<bool> &new_held);

    bool
    is_held(const unsigned int edge) const
    {
      return held[edge];
    }

    const std::vector<ShellHinge> &
    get_hinges() const
    {
      return hinges;
    }

    /// Turns at the three edges of a triangle.
    const std::array<ShellTurn, 3> &
    turns(const unsigned int triangle) const
    {
      return turns_of_triangles[triangle];
    }

    HingeAngle<double>
    hinge_angle(unsigned int hinge, const Vector &positions) const;

    /// The angle of a hinge less that at rest, on the branch nearest the last state.
    double
    change(unsigned int hinge, const HingeAngle<double> &angle) const;

    /// Let these positions be those of the last state. Angles are within pi of those there. At
    /// first they are those of a surface that nowhere folds through itself: within pi of a plane.
    void
    update_branches(const Vector &positions);

    MembraneStrain<double>
    membrane(unsigned int triangle, const Vector &positions) const;

    /// Turns [rad] of the normals at the three edges, from the changes of all hinges.
    std::array<double, 3>
    turns_of(unsigned int               triangle,
             const Vector              &positions,
             const std::vector<double> &changes) const;

    /// Edge i of a triangle.
    ShellStretch
    stretch(unsigned int triangle, unsigned int i, const Vector &positions) const;

    /// From the membrane and the turns of a triangle.
    ShellStrain
    strain(unsigned int                  triangle,
           const Vector                 &positions,
           const MembraneStrain<double> &membrane,
           const std::array<double, 3>  &turns) const;

    /// Strains of all triangles.
    std::vector<ShellStrain>
    strains(const Vector &positions) const;

    /// The slope l phi [m] of each edge of a plate at these positions, whether it is held or not.
    std::vector<double>
    slopes(const Vector &positions) const;

    /// The place of the director's tip of an edge that is not held: that of a slope node from which it
    /// may be held.
    Vector3<double>
    tip(unsigned int edge, const Vector &positions) const;

    /// The slopes [m] of a plate of least bending energy for given places of the vertices, whatever is held; they are unique. `elasticity`
    /// is that of a triangle.
    std::vector<double>
    least_bending_slopes(const Vector                                       &positions,
                         const std::function<ShellElasticity(unsigned int)> &elasticity) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    std::vector<double>
    changes(const Vector &positions) const;

    void
    find_turns();

    ShellTurn
    make_turn(unsigned int triangle, unsigned int i);

    /// An angle on the branch nearest the last state.
    double
    nearest(unsigned int edge, unsigned int kind, double angle) const;

    /// The angle of an edge's two triangles; 0 at a border.
    double
    angle_of_triangles(unsigned int edge, const Vector &positions) const;

    const ShellMesh                      &mesh;
    std::vector<bool>                     held;
    std::vector<std::array<double, 3>>    last_angles; ///< of each edge by ShellHinge::kind
    std::vector<ShellHinge>               hinges;
    std::vector<std::array<ShellTurn, 3>> turns_of_triangles;
  };
} // namespace Exemplar

#endif
