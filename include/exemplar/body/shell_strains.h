// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shell_strains_h
#define exemplar_shell_strains_h

#include <exemplar/body/tip_frame.h>

#include <array>
#include <functional>
#include <vector>

namespace Exemplar
{
  using ShellStrain     = ShellNumbers<double>;
  using ShellElasticity = TriangleElasticity<double>;

  /// TargetSpace::order for strains.
  inline std::vector<unsigned int>
  shell_strain_order()
  {
    return { 0, 2, 2, 1, 3, 5, 5, 4 };
  }

  /// Four nodes of which HingeAngle is a strain.
  struct ShellHinge
  {
    std::array<unsigned int, 4> nodes;
    double                      rest;  ///< the angle at rest
    unsigned int                owner; ///< a triangle all of whose hinges' nodes include these
    unsigned int edge, kind; ///< 0: of its two triangles; 1, 2: of one of these and the director
    int          frame = -1; ///< of a director that follows its edge; -1: none
    double       shift = 0.; ///< added to the angle, which is then that of the normal [rad]
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

  /// The strains of a shell. Those of a plate are by Grinspun, Gingold, Reisman and Zorin (2006). The normal at the middle of
  /// an edge turns out of the bisector of its triangles. Degree of freedom 3 p of its slope node p is its length
  /// times that turn; but where the node is held, its place is that of the tip of the edge's director, which
  /// the normal follows, see TipFrame. Hinges (Froehlich and Botsch 2011) have no slopes: their strains are lengths and
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

    /// Let these slope nodes be held.
    void
    set_held(const HeldTips &new_held);

    bool
    is_held(const unsigned int edge) const
    {
      return held[edge] != 0;
    }

    /// Whether directors follow their edges.
    bool
    has_frames() const
    {
      return !frames.empty();
    }

    /// Positions in which slope nodes of directors that follow their edges are the fourth nodes of hinges.
    Vector
    with_fourth_nodes(Vector positions) const;

    /// The derivative of a hinge's angle with respect to its nodes, from that with respect to the four positions of HingeAngle.
    HingeForm<double>
    pulled_back(const unsigned int hinge, const HingeForm<double> &form) const
    {
      const int frame = hinges[hinge].frame;
      return frame < 0 ? form : frames[frame].pulled_back(form);
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

    /// The derivative of the angle with respect to the hinge's nodes, and the second one.
    HingeForm<double>
    hinge_gradient(unsigned int hinge, const Vector &positions) const;

    std::array<HingeProduct<double>, 4>
    hinge_hessian(unsigned int hinge, const Vector &positions) const;

    /// The angle of a hinge less that at rest, on the branch nearest the last state.
    double
    change(unsigned int hinge, const HingeAngle<double> &angle) const;

    /// Let these positions be those of the last state. Angles are within pi of those there. At
    /// first they are those of a surface that nowhere folds through itself: within pi of a plane.
    void
    update_branches(const Vector &positions);

    /// The angles of the last state: for each triangle those with the triangles beyond its edges, then those with the
    /// directors of these. For State::history.
    std::vector<double>
    branches() const;

    /// Let these be the angles of the last state; empty: as at first.
    void
    set_branches(const std::vector<double> &angles);

    /// Of a hinge, in the last state.
    double
    last_angle(const unsigned int hinge) const
    {
      return last_angles[hinges[hinge].edge][hinges[hinge].kind];
    }

    /// A triangle with its vertices where they are.
    TriangleStrain<double>
    triangle(unsigned int triangle, const Vector &positions) const;

    /// Turns [rad] of the normals at the three edges of a triangle, from the changes of all hinges.
    std::array<double, 3>
    turns_of(unsigned int               triangle,
             const Vector              &positions,
             const std::vector<double> &changes) const;

    /// Strains of all triangles.
    std::vector<ShellStrain>
    strains(const Vector &positions) const;

    /// How they change along changes of the positions.
    std::vector<ShellStrain>
    strain_changes(const Vector &positions, const Vector &along) const;

    /// Chain rule: add the derivatives by positions of a function of the strains there, with T.b = contract(T, b) its
    /// change by strains b of a triangle.
    void
    add_pulled_back(const Vector                   &positions,
                    const std::vector<ShellStrain> &stresses,
                    Vector                         &to) const;

    /// The slope l phi [m] of each edge of a plate at these positions, whether it is held or not.
    std::vector<double>
    slopes(const Vector &positions) const;

    /// The place of the director's tip of an edge that is not held: that of a slope node from which it
    /// may be held.
    Vector3<double>
    tip(unsigned int edge, const Vector &positions) const;

    /// The position of an edge's slope node from which it may be held as it is now, for the tip of its normal.
    Vector3<double>
    held_node(unsigned int edge, const Vector3<double> &tip, const Vector &positions) const;

    /// The slopes [m] of a plate of least bending energy for given places of the vertices, whatever is held; they are unique. `elasticity`
    /// is that of a triangle.
    std::vector<double>
    least_bending_slopes(const Vector                                       &positions,
                         const std::function<ShellElasticity(unsigned int)> &elasticity) const;

    /// The chain rule for least_bending_slopes(), for a function with these derivatives with respect to the slopes [1/m]: a strain e
    /// of each triangle. Where the stress of the pose's curvatures changes by T in a triangle, as its elasticity or thickness
    /// changes, the function changes by -volume contract(T, e).
    std::vector<ShellStrain>
    adjoint_of_least_bending(const std::vector<double>                          &by_slopes,
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
    HeldTips                              held;
    std::vector<TipFrame>                 frames;        ///< of directors that follow their edges
    std::vector<int>                      frame_of_edge; ///< -1: none
    std::vector<std::array<double, 3>>    last_angles;   ///< of each edge by ShellHinge::kind
    std::vector<ShellHinge>               hinges;
    std::vector<std::array<ShellTurn, 3>> turns_of_triangles;
  };
} // namespace Exemplar

#endif
