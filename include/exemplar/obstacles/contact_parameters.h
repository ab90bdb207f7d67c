// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_parameters_h
#define exemplar_contact_parameters_h

#include <exemplar/mesh/selection.h>
#include <exemplar/prm/key_table.h>

#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// Throws UserError unless the text of a key is auto or a positive number.
  void
  check_length(const std::string &text, const std::string &key, const std::string &unit);

  /// Throws UserError unless the coefficient of friction of a key is from 0 to 1e6, where surfaces stick. The squares
  /// of much greater ones times forces leave the range of numbers.
  void
  check_friction(double friction, const std::string &key);

  /// The distance [m] from which a body of this diameter [m] is pushed, by the text of a key: a number [m], or auto. Throws
  /// UserError for a number that is above a tenth of the diameter or below a millionth.
  double
  contact_distance(const std::string &text, const std::string &key, double diameter);

  /// Section Contact: of the body with itself.
  struct ContactParameters
  {
    bool        self       = false;  ///< each piece with itself and with others
    bool        bodies     = false;  ///< pieces with each other
    double      friction   = 0.;     ///< coefficient [-]
    std::string distance   = "auto"; ///< d_hat [m]
    std::string slip_speed = "auto"; ///< [m/s]
    std::string leave_out;           ///< selections, separated by semicolons

    void
    declare(KeyTable &keys);

    /// Throws UserError for a distance that is no number, and for selections without a word.
    void
    check() const;

    /// Those of Leave out, each with its key; none where nothing is kept apart.
    std::vector<std::pair<Selection, std::string>>
    selections() const;

    /// The text of a Leave out with absolute paths of the selections' files.
    static std::string
    absolute_leave_out(const std::string &text, const std::filesystem::path &directory);

    bool
    empty() const
    {
      return !self && !bodies;
    }
  };
} // namespace Exemplar

#endif
