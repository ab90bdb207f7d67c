// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/time_axis.h>

#include <cmath>

namespace Exemplar
{
  TimeAxis::TimeAxis(const unsigned int steps,
                     const double       length,
                     const double       divisor,
                     const double       end)
      : steps(steps), length(length), divisor(divisor), end(end),
        last_is_shorter(end < steps * length / divisor * (1. - 1e-12))
  {
  }

  TimeAxis
  TimeAxis::of_dynamics(const TimeParameters &parameters)
  {
    // a quotient a rounding error above a whole number is that number of steps
    const double quotient = parameters.end / parameters.step;
    const double steps    = std::max(1., std::ceil(quotient * (1. - 1e-12)));
    if (steps > 1e9)
      throw UserError("Time/End / Time/Step = " + shortest_text(quotient)
                      + " is more than 1e9 steps. Enlarge Time/Step or lower Time/End.");
    return { static_cast<unsigned int>(steps), parameters.step, 1., parameters.end };
  }

  TimeAxis
  TimeAxis::of_increments(const TimeParameters &parameters)
  {
    return { parameters.increments, 1., static_cast<double>(parameters.increments), 1. };
  }
} // namespace Exemplar
