// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/base/words.h>
#include <exemplar/live/command.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
    using Json = nlohmann::json;

    constexpr std::size_t max_name = 64, max_vertices = 20000;

    /// Greatest count of numbers for types that take any count.
    constexpr std::size_t any_number = 1000;

    /// Members that a type of command has beside "type".
    struct Shape
    {
      bool        has_name;
      std::size_t n_numbers;
      bool        has_triangle, has_vertices, has_on;
    };

    const std::map<std::string, Shape> shapes = {
      { "grab", { true, 7, true, false, true } },   // shares, anchor, stiffness; on: hard
      { "move", { true, 3, false, false, false } }, // anchor
      { "release", { true, 0, false, false, false } },
      { "put", { true, any_number, false, false, false } }, // 5 of a ball, 7 of a block
      { "carry", { true, 3, false, false, false } },        // displacement of an obstacle
      { "take away", { true, 0, false, false, false } },
      { "pin", { true, 0, false, true, false } },
      { "unpin", { true, 0, false, false, false } },
      { "handle", { true, 3, false, false, false } }, // displacement
      { "set", { true, 1, false, false, false } },
      { "tension", { true, 1, false, false, false } }, // of a region [Pa]
      { "weights", { false, any_number, false, false, false } },
      { "energy", { true, 0, false, false, false } }, // a value of Examples/Energy
      { "gravity", { false, 3, false, false, false } },
      { "damping", { false, 2, false, false, false } },
      { "pause", { false, 0, false, false, true } },
      { "step", { false, 0, false, false, false } },
      { "reset", { false, 0, false, false, false } },
      { "undo", { false, 0, false, false, false } },
      { "colour", { true, 0, false, false, false } },
      { "save pose", { false, 0, false, false, false } },
      { "add example", { false, 0, false, false, false } },
      { "take mouse", { false, 0, false, false, false } },
    };

    template <typename Number>
    std::vector<Number>
    list_of(const Json &message, const char *key, const std::size_t max)
    {
      const Json &list = message.at(key);
      if (!list.is_array() || list.size() > max)
        throw std::invalid_argument(std::string(key) + " is no list, or too long");
      std::vector<Number> numbers;
      for (const Json &entry : list)
      {
        const bool is_right
            = std::is_same_v<Number, double> ? entry.is_number() : entry.is_number_unsigned();
        if (!is_right || !(std::abs(entry.get<double>()) < 1e30))
          throw std::invalid_argument(std::string(key) + " holds what is no number");
        if (!std::is_same_v<Number, double> && entry.get<double>() > 4e9)
          throw std::invalid_argument(std::string(key) + " holds a number that is too large");
        numbers.push_back(entry.get<Number>());
      }
      return numbers;
    }

    unsigned int
    index_of(const Json &message, const char *key)
    {
      const Json &value = message.at(key);
      if (!value.is_number_unsigned() || value.get<double>() > 4e9)
        throw std::invalid_argument(std::string(key) + " is no whole number");
      return value.get<unsigned int>();
    }

    std::string
    word_of(const Json &message, const char *key)
    {
      const Json &value = message.at(key);
      if (!value.is_string() || value.get_ref<const std::string &>().size() > max_name)
        throw std::invalid_argument(std::string(key) + " is no word, or too long");
      const auto word = value.get<std::string>();
      if (word.empty() || word.find('|') != std::string::npos
          || find_unprintable(word) != std::string::npos || word.find('\t') != std::string::npos
          || word != trim(word)) // session files trim words between |
        throw std::invalid_argument(std::string(key)
                                    + " is empty, begins or ends with a blank, or has a | or what "
                                      "is no text");
      return word;
    }

    Command
    command_of(const Json &message)
    {
      if (!message.is_object())
        throw std::invalid_argument("a message is an object of JSON");
      Command    command{ word_of(message, "type") };
      const auto shape = shapes.find(command.type);
      if (shape == shapes.end())
        throw std::invalid_argument("there is no such type");
      const auto &[has_name, n_numbers, has_triangle, has_vertices, has_on] = shape->second;
      if (has_name)
        command.name = word_of(message, "name");
      if (n_numbers > 0)
        command.numbers = list_of<double>(message, "numbers", n_numbers);
      if (n_numbers < any_number && command.numbers.size() != n_numbers)
        throw std::invalid_argument("numbers are too few");
      if (has_triangle)
        command.triangle = index_of(message, "triangle");
      if (has_vertices)
        command.vertices = list_of<unsigned int>(message, "vertices", max_vertices);
      if (has_on)
        command.on = message.at("on").get<bool>();
      if (message.contains("sequence"))
        command.sequence = index_of(message, "sequence");
      return command;
    }
  } // namespace

  Command
  parse_command(const std::string_view message)
  {
    const Json parsed = Json::parse(message, nullptr, false);
    if (parsed.is_discarded())
      throw std::invalid_argument("a message is an object of JSON");
    try
    {
      return command_of(parsed);
    }
    catch (const Json::exception &)
    {
      throw std::invalid_argument("something is missing, or of another kind");
    }
  }
} // namespace Exemplar::Live
