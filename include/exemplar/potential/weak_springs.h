// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weak_springs_h
#define exemplar_weak_springs_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/obstacles/contact_surface.h>
#include <exemplar/obstacles/obstacle_parameters.h>
#include <exemplar/potential/evaluation.h>

namespace Exemplar
{
  /// Springs between a static body's surface and the places where it stands, so weak that what obstacles do hardly feels
  /// them: k = factor E L of mean stiffness E and size L, in shares of the surface. They hold the motions that neither
  /// handles nor obstacles do.
  class WeakSprings
  {
  public:
    /// `size` L is in m; at the places `rest` nothing pulls. All must outlive the object.
    WeakSprings(FreeBodies kind, double size, const ContactSurface &surface, const Vector &rest);

    void
    attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs)
    {
      pattern   = &new_pattern;
      free_dofs = &new_free_dofs;
    }

    /// An increment of statics begins at these positions. All processes must call this.
    void
    begin_step(const Vector &positions);

    /// States belong to no increment from now on.
    void
    leave_step()
    {
      in_step = false;
    }

    /// Friction holds from now on; false if it has held before, or need not.
    bool
    let_go();

    void
    add(const Vector &positions, ElasticSums &sums) const;

    /// The part of their energy that is lost where the next step begins, whose springs have other anchors [J].
    double
    lost_energy(const Vector &positions) const;

    void
    add_tangent(std::vector<double> &values) const;

    void
    add_response(const Vector &displacement, ElasticSums &sums) const;

    /// On the body, of this process [N].
    dealii::Tensor<1, 3>
    force(const Vector &positions) const;

    FreeBodies
    get_kind() const
    {
      return kind;
    }

  private:
    /// Of a node, now [N/m].
    double
    stiffness(const ContactSurface::Node &node) const;

    const FreeBodies        kind;
    const double            size;
    const ContactSurface   &surface;
    double                  by_area = 0.; ///< E L / surface [N/m^3]
    Vector                  anchors;
    bool                    in_step    = false;
    bool                    has_let_go = false;
    const SymmetricPattern *pattern    = nullptr; ///< since attach()
    const FreeDofs         *free_dofs  = nullptr; ///< since attach()
  };
} // namespace Exemplar

#endif
