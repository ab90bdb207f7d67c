// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/agreement.h>

#include <stdexcept>
#include <string>

namespace Exemplar
{
  namespace
  {
    // the first letter of a message says what it is thrown as
    constexpr char user_error = 'u', solver_failure = 's', other_error = 'o';

    std::string
    error_of(const std::function<void()> &action)
    {
      try
      {
        action();
      }
      catch (const UserError &error)
      {
        return user_error + std::string(error.what());
      }
      catch (const SolverFailure &failure)
      {
        return solver_failure + std::string(failure.what());
      }
      catch (const std::exception &error)
      {
        return other_error + std::string(error.what());
      }
      return {};
    }
  } // namespace

  void
  do_in_agreement(const Exchange &exchange, const std::function<void()> &action)
  {
    if (exchange.n_processes() == 1)
    {
      action();
      return;
    }
    const std::string error = exchange.first_text(error_of(action));
    if (error.empty())
      return;
    const std::string message = error.substr(1);
    if (error[0] == user_error)
      throw UserError(message);
    if (error[0] == solver_failure)
      throw SolverFailure(message);
    throw std::runtime_error(message);
  }

  void
  do_at_root(const Exchange &exchange, const std::function<void()> &action)
  {
    do_in_agreement(exchange,
                    [&]
                    {
                      if (exchange.is_root())
                        action();
                    });
  }
} // namespace Exemplar
