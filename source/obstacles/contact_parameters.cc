// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/obstacles/contact_parameters.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t max_left_out = 64; ///< selections, of which a node has a bit each
  }

  void
  check_length(const std::string &text, const std::string &key, const std::string &unit)
  {
    if (text != "auto" && !(parse_number(text) > 0. && std::isfinite(parse_number(text))))
      throw UserError(key + " = '" + text
                      + "' is not allowed. Allowed: auto, or a positive number [" + unit + "].");
  }

  void
  check_friction(const double friction, const std::string &key)
  {
    constexpr double greatest = 1e6;
    if (!(friction >= 0. && friction <= greatest))
      throw UserError(key + " = " + short_text(friction) + " is not allowed. Allowed: 0 to 1e6.");
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
        "From where surfaces push each other [m]; auto: 5e-3 of the diameter of the smaller one of "
        "the two pieces.");
    keys.add("Slip speed", slip_speed,
             "Speed [m/s] from which friction is that of a sliding contact: what sticks creeps "
             "below it; "
             "auto: 1e-3 of the diameter of the smaller one of the two pieces, per second.");
    keys.add(
        "Leave out", leave_out,
        "Parts of the surface that never touch each other, as an eye and its socket: selections "
        "as in Handles, separated by semicolons. What lies in one does not meet what lies in "
        "another one; parts of a single selection do not meet each other. Empty: none.");
    keys.leave_subsection();
  }

  void
  ContactParameters::check() const
  {
    check_length(distance, "Contact/Distance", "m");
    check_length(slip_speed, "Contact/Slip speed", "m/s");
    check_friction(friction, "Contact/Friction");
    if (leave_out.empty())
      return;
    const std::vector<std::string> texts = split_trimmed(leave_out, ';');
    if (std::count(texts.begin(), texts.end(), "") > 0)
      throw UserError("Contact/Leave out = '" + leave_out
                      + "' has a selection without a word. Allowed: selections as in Handles, "
                        "separated by semicolons.");
    if (texts.size() > max_left_out)
      throw UserError("Contact/Leave out has " + std::to_string(texts.size())
                      + " selections. Allowed: " + std::to_string(max_left_out) + " at most.");
  }

  std::vector<std::pair<Selection, std::string>>
  ContactParameters::selections() const
  {
    std::vector<std::pair<Selection, std::string>> all;
    if (empty() || leave_out.empty())
      return all;
    for (const std::string &text : split_trimmed(leave_out, ';'))
      all.emplace_back(Selection{ text }, "Contact/Leave out");
    return all;
  }

  std::string
  ContactParameters::absolute_leave_out(const std::string           &text,
                                        const std::filesystem::path &directory)
  {
    std::string result;
    if (!text.empty())
      for (const std::string &selection : split_trimmed(text, ';'))
        result += (result.empty() ? "" : "; ") + Selection::absolute(selection, directory);
    return result;
  }
} // namespace Exemplar
