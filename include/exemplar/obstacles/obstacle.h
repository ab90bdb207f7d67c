// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_h
#define exemplar_obstacle_h

#include <exemplar/obstacles/obstacle_parameters.h>
#include <exemplar/obstacles/obstacle_shape.h>
#include <exemplar/obstacles/rigid_track.h>
#include <exemplar/prm/expression.h>

#include <deal.II/base/tensor.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// What files say of an obstacle: a surface [m], if it is one, the places of its vertices in time, if it follows a
  /// cache, and how it moves, if it follows a track.
  struct ObstacleSurface
  {
    std::vector<std::array<double, 3>>       vertices;
    std::vector<std::array<unsigned int, 3>> triangles;
    std::vector<double> times; ///< [s], ascending; empty: it does not move by itself
    std::vector<std::vector<std::array<double, 3>>> samples; ///< vertices at these times [m]
    RigidTrack                                      track;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &vertices &triangles &times &samples &track;
    }
  };

  /// Surfaces by the names of the obstacles.
  using ObstacleSurfaces = std::map<std::string, ObstacleSurface>;

  /// Where axes of an obstacle stand: x = rotation X + place.
  struct ObstaclePose
  {
    dealii::Tensor<2, 3> rotation;
    SpaceVector3         place; ///< [m]

    SpaceVector3
    to_space(const SpaceVector3 &own) const
    {
      return rotation * own + place;
    }

    SpaceVector3
    to_own(const SpaceVector3 &in_space) const
    {
      return dealii::transpose(rotation) * (in_space - place);
    }
  };

  /// What the body may not pass, and how it moves.
  class Obstacle
  {
  public:
    /// `surface` is null unless the shape is one or files tell how it moves. Throws UserError for a shape or formulas that are none, and for a
    /// surface that intersects itself.
    Obstacle(const ObstacleParameters &parameters, const ObstacleSurface *surface);

    const std::string &
    name() const
    {
      return called;
    }

    double
    friction() const
    {
      return coefficient;
    }

    /// Whether it is there in a step that begins at this time [s].
    bool
    is_there(const double time) const
    {
      return !is_gone && when.holds(time, rounding);
    }

    /// Let it be nowhere from now on.
    void
    leave()
    {
      is_gone = true;
    }

    bool
    has_left() const
    {
      return is_gone;
    }

    /// Let it go straight, between two times [s], to this displacement [m] from where it is without being carried.
    void
    carry(const SpaceVector3 &to, double begin, double end);

    /// Whether it is there at all times.
    bool
    is_always_there() const
    {
      return when.is_always();
    }

    /// Whether From lets it appear after t = 0.
    bool
    appears() const
    {
      return when.from > 0.;
    }

    const ObstacleShape &
    shape() const
    {
      return own_shape;
    }

    /// Where its axes stand at a time [s]. Throws SolverFailure for what is not finite.
    ObstaclePose
    pose(double time) const;

    /// Whether its vertices move by themselves.
    bool
    deforms() const
    {
      return !track.times.empty();
    }

    /// The vertices at a time [s], in its axes [m].
    std::vector<SpaceVector3>
    vertices(double time) const;

    /// Whether it stands elsewhere at these times [s].
    bool
    moves_between(double time, double other_time) const;

    /// Let it be farther from the body, by this [m], for all times; a surface goes along `direction`.
    void
    set_back(double by, const SpaceVector3 &direction);

    bool
    was_set_back() const
    {
      return n_set_back > 0;
    }

    /// Number of calls of set_back().
    unsigned int
    version() const
    {
      return n_set_back;
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// The rotation vector [rad]. Throws SolverFailure if it is not finite or too long.
    const SpaceVector3 &
    checked_turn(const SpaceVector3 &rotation_vector, double time) const;

    /// The pose. Throws SolverFailure if it is not finite or too far away.
    ObstaclePose
    checked(const ObstaclePose &pose, double time) const;
    /// A displacement [m] that grows between two times [s] from one to another.
    struct Carriage
    {
      double       begin = 0., end = 0.;
      SpaceVector3 from, to;

      SpaceVector3
      at(double time) const;
    };

    static constexpr double rounding = 1e-12; ///< of times [s]

    std::string     called;
    double          coefficient;
    HoldingTime     when;
    ObstacleShape   own_shape;
    Expression      motion, turn;
    ObstacleSurface track; ///< what it follows: without the surface
    SpaceVector3    shift;
    Carriage        carried    = {};
    bool            is_gone    = false;
    unsigned int    n_set_back = 0;
  };

  /// The rotation by a vector [rad].
  dealii::Tensor<2, 3>
  rotation_by(const SpaceVector3 &vector);
} // namespace Exemplar

#endif
