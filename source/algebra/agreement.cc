// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/base/errors.h>

#include <exception>
#include <stdexcept>
#include <string>

namespace Exemplar
{
  namespace
  {
    // the first letter of a message says what it is thrown as
    constexpr char user_error = 'u', solver_failure = 's', other_error = 'o';

    std::string
    message_of(const std::exception_ptr &error)
    {
      try
      {
        std::rethrow_exception(error);
      }
      catch (const UserError &user)
      {
        return user_error + std::string(user.what());
      }
      catch (const SolverFailure &failure)
      {
        return solver_failure + std::string(failure.what());
      }
      catch (const std::exception &other)
      {
        return other_error + std::string(other.what());
      }
    }

    /// Rethrow the exception of another process.
    [[noreturn]] void
    throw_as(const char kind, const std::string &message)
    {
      if (kind == user_error)
        throw UserError(message);
      if (kind == solver_failure)
        throw SolverFailure(message);
      throw std::runtime_error(message);
    }
  } // namespace

  void
  do_in_agreement(const Exchange &exchange, const std::function<void()> &action)
  {
    std::exception_ptr own;
    try
    {
      action();
    }
    catch (const std::exception &)
    {
      own = std::current_exception();
    }
    const std::string message = exchange.first_text(own == nullptr ? "" : message_of(own));
    if (own != nullptr)
      std::rethrow_exception(own); // unchanged: its type and data may tell more than its text
    if (!message.empty())
      throw_as(message[0], message.substr(1));
  }

  void
  do_at_root(const Exchange &exchange, const std::function<void()> &action)
  {
    do_in_agreement(exchange, [&] { at_root(exchange, action); });
  }
} // namespace Exemplar
