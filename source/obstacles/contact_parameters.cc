// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/obstacles/contact_parameters.h>

#include <cmath>

namespace Exemplar
{
  void
  check_length(const std::string &text, const std::string &key, const std::string &unit)
  {
    if (text != "auto" && !(parse_number(text) > 0. && std::isfinite(parse_number(text))))
      throw UserError(key + " = '" + text
                      + "' is not allowed. Allowed: auto, or a positive number [" + unit + "].");
  }

  double
  contact_distance(const std::string &text, const std::string &key, const double diameter)
  {
    if (text == "auto")
      return 5e-3 * diameter;
    const double given = parse_number(text), least = 1e-6 * diameter, greatest = 0.1 * diameter;
    if (given < least || given > greatest)
      throw UserError(
          key + " = " + text + " m is " + (given < least ? "below a millionth" : "above a tenth")
          + " of the body's diameter of " + short_text(diameter) + " m. Take a number between "
          + short_text(least) + " and " + short_text(greatest) + ", or auto.");
    return given;
  }

  void
  ContactParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Contact");
    keys.add("Self", self,
             "Whether the body may not pass through itself, in one piece or in several.");
    keys.add("Bodies", bodies,
             "Whether pieces of the mesh may not pass through each other. Each may pass through "
             "itself.");
    keys.add("Friction", friction, "Coefficient of Coulomb's friction of surfaces that meet.");
    keys.add(
        "Distance", distance,
        "From where surfaces push each other [m]; auto: 5e-3 of the largest piece's diameter.");
    keys.add("Slip speed", slip_speed,
             "Speed [m/s] from which friction is that of a sliding contact: what sticks creeps "
             "below it; "
             "auto: 1e-3 of the largest piece's diameter a second.");
    keys.leave_subsection();
  }

  void
  ContactParameters::check() const
  {
    check_length(distance, "Contact/Distance", "m");
    check_length(slip_speed, "Contact/Slip speed", "m/s");
    if (!(friction >= 0.))
      throw UserError("Contact/Friction = " + shortest_text(friction)
                      + " is not allowed. Allowed: 0 or more.");
  }
} // namespace Exemplar
