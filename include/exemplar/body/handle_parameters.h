// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handle_parameters_h
#define exemplar_handle_parameters_h

#include <exemplar/mesh/selection.h>

#include <limits>
#include <string>

namespace Exemplar
{
  class KeyTable;

  /// When a handle holds its nodes, by the time t at which a step begins: for from <= t < until or,
  /// if until < from, outside [until, from).
  struct HoldingTime
  {
    double from  = 0.; ///< [s]
    double until = std::numeric_limits<double>::infinity();

    bool
    is_always() const
    {
      return from <= 0. && until == std::numeric_limits<double>::infinity();
    }

    /// Whether the handle holds in a step that begins at time t [s]; times may be off by `rounding`
    /// [s].
    bool
    holds(const double time, const double rounding) const
    {
      const bool is_caught = time >= from - rounding, is_let_go = time >= until - rounding;
      return from < until ? is_caught && !is_let_go : is_caught || !is_let_go;
    }

    /// Whether the nodes have been caught by a step that begins at that time, rather than held from
    /// the start.
    bool
    has_caught(const double time, const double rounding) const
    {
      return from > 0. && time >= from - rounding;
    }
  };

  /// Parameters of a subsection of Handles.
  struct HandleParameters
  {
    std::string name;
    Selection   select;
    std::string motion     = "0; 0; 0";
    std::string components = "x, y, z";
    std::string slopes     = "auto"; ///< held or free; auto: held where all components are
    std::string follow_pose;         ///< a file; empty: `motion` says where the nodes go
    std::string progress = "t";
    std::string follow_cache; ///< a file of places of the surface's vertices in time; empty: none
    double      frames_per_second = 24.;
    std::string cache_start       = "file"; ///< t of the first sample [s], or as the file has it
    double      from              = 0.;     ///< [s]
    std::string until             = "end";  ///< [s], or the end of the scene

    void
    declare(KeyTable &keys);

    /// Throws UserError if more than one of a motion, a pose and a cache to follow is given, for a
    /// key that belongs to none of those given, and for an invalid From or Until.
    void
    check() const;

    /// Whether the normals of a shell at edges between held nodes turn with the handle.
    bool
    holds_slopes() const;

    /// The values of From and Until. check() must have passed.
    HoldingTime
    holding_time() const;

  private:
    void
    check_time(const std::string &key) const;
  };
} // namespace Exemplar

#endif
