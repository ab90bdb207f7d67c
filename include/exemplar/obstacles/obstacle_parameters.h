// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_obstacle_parameters_h
#define exemplar_obstacle_parameters_h

#include <exemplar/body/handle_parameters.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Parameters of a subsection of Obstacles.
  struct ObstacleParameters
  {
    std::string name;
    std::string shape;                     ///< with an absolute FILE of "surface FILE"
    std::string motion = "0; 0; 0";        ///< displacement by t [m]
    std::string turn   = "0; 0; 0";        ///< rotation vector by t [rad]
    std::string follow_cache;              ///< of the vertices of a surface; empty: none
    std::string follow_track;              ///< a file of a rigid motion; empty: none
    double      frames_per_second = 24.;   ///< of the cache
    double      friction          = 0.;    ///< coefficient [-]
    double      from              = 0.;    ///< [s]
    std::string until             = "end"; ///< [s]

    void
    declare(KeyTable &keys);

    /// Throws UserError for a shape that is none, and for keys that contradict each other.
    void
    check() const;

    /// Whether no key moves it. Formulas that are constant are not looked into.
    bool
    stays() const;

    /// When it is there. check() must have passed.
    HoldingTime
    time() const;

    /// The FILE of "surface FILE"; empty for other shapes.
    std::string
    surface_file() const;

    /// `shape` with an absolute FILE, if `directory` is given.
    static std::string
    absolute_shape(const std::string &shape, const std::filesystem::path &directory);
  };

  /// What holds a static body's motions that no handle does.
  enum class FreeBodies
  {
    refused,
    friction,
    weak_springs
  };

  /// Section Obstacles.
  struct ObstaclesParameters
  {
    std::string                     distance      = "auto"; ///< d_hat [m]
    std::string                     slip_speed    = "auto"; ///< [m/s]
    double                          lag_tolerance = 1e-3;
    FreeBodies                      free          = FreeBodies::refused;
    std::vector<ObstacleParameters> named;

    void
    declare(KeyTable &keys);

    /// Throws UserError as ObstacleParameters::check(), and for a distance or slip speed that is no number.
    void
    check() const;

    bool
    empty() const
    {
      return named.empty();
    }

    bool
    has_friction() const;
  };
} // namespace Exemplar

#endif
