// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_key_table_h
#define exemplar_key_table_h

#include <exemplar/base/errors.h>
#include <exemplar/prm/assignments.h>

#include <array>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// A key that is declared nowhere, as opposed to a value that is not allowed.
  class UnknownKey : public UserError
  {
    using UserError::UserError;
  };

  /// One table per enum gives its names in scene files and in messages.
  template <typename Enum>
  using EnumTable = std::vector<std::pair<Enum, std::string>>;

  template <typename Enum>
  std::string
  enum_name(const Enum value, const EnumTable<Enum> &table)
  {
    for (const auto &[entry, name] : table)
      if (entry == value)
        return name;
    throw std::logic_error("enum value without a name");
  }

  /// The numbers that are allowed, bounds included.
  struct Bounds
  {
    double low  = std::numeric_limits<double>::lowest();
    double high = std::numeric_limits<double>::max();

    /// Greater than 0: the least positive number that makes sense keeps 0 out.
    static Bounds
    positive()
    {
      return { 1e-300 };
    }
  };

  /// A declared key: where it is, what it says, and what it may say.
  struct DeclaredKey
  {
    std::vector<std::string> subsections;
    std::string              key;
    std::string              value; ///< as it was set, else the default
    std::string              default_value;
    std::string              documentation;
    std::string              allowed;               ///< in words
    bool                     is_input_file = false; ///< of one file, or of a list of files
    bool                     is_list       = false; ///< values separated by commas

    std::string
    path() const;
  };

  /// The keys of a file, each bound to a variable that the text of its value is written to. The
  /// present content of the variable is the default. Variables must stay where they are.
  class KeyTable
  {
  public:
    KeyTable()                 = default;
    KeyTable(const KeyTable &) = delete;
    KeyTable &
    operator=(const KeyTable &)
        = delete;

    /// What is declared from now on lies in a subsection of the present one.
    void
    enter_subsection(const std::string &name);

    void
    leave_subsection();

    void
    add(const std::string &key,
        double            &value,
        const std::string &documentation,
        const Bounds      &bounds = {});

    /// The bounds are whole numbers.
    void
    add(const std::string &key,
        unsigned int      &value,
        const std::string &documentation,
        const Bounds      &bounds);

    void
    add(const std::string &key, bool &value, const std::string &documentation);

    void
    add(const std::string &key, std::string &value, const std::string &documentation);

    void
    add(const std::string     &key,
        std::array<double, 3> &value,
        const std::string     &documentation,
        const Bounds          &bounds = {});

    void
    add(const std::string           &key,
        std::array<unsigned int, 3> &value,
        const std::string           &documentation,
        const Bounds                &bounds);

    /// A choice among the names of a table, which must outlive this.
    template <typename Enum>
    void
    add(const std::string     &key,
        Enum                  &value,
        const EnumTable<Enum> &table,
        const std::string     &documentation);

    /// Names separated by commas.
    void
    add_names(const std::string        &key,
              std::vector<std::string> &value,
              const std::string        &documentation);

    /// One or more of `names`, each once, separated by commas.
    void
    add_choices(const std::string              &key,
                std::vector<std::string>       &value,
                const std::vector<std::string> &names,
                const std::string              &documentation);

    /// The name of an input file.
    void
    add_file(const std::string &key, std::string &value, const std::string &documentation);

    /// Names of input files, separated by commas.
    void
    add_files(const std::string        &key,
              std::vector<std::string> &value,
              const std::string        &documentation);

    /// All keys: those of a subsection follow one another, in order of declaration.
    std::vector<DeclaredKey>
    keys() const;

    /// Whether there is a key of this path ("Section/Key").
    bool
    declares(const std::string &path) const;

    /// The text of a key that there is, by "Section/Key".
    const std::string &
    get(const std::string &path) const;

    /// Give a key that there is a text that is allowed.
    void
    set(const std::string &path, const std::string &text);

    /// Set values; input files become absolute, relative ones starting from `directory`; if that
    /// is empty, they stay. Throws UnknownKey for an undeclared key (with the nearest declared
    /// ones) and UserError for a value that is not allowed.
    void
    apply(const std::vector<Assignment> &assignments, const std::filesystem::path &directory);

  private:
    /// Writes a text to a variable; false if it is not allowed.
    using Setter = std::function<bool(const std::string &)>;

    /// A key and how its text becomes a value.
    struct Entry
    {
      DeclaredKey declared;
      Setter      set;
    };

    template <typename Value, typename Pattern>
    void
    add_pattern(DeclaredKey declared, Value &value, const Pattern &pattern);

    void
    add_choice(const std::string              &key,
               const std::string              &name,
               const std::vector<std::string> &names,
               const std::string              &documentation,
               const Setter                   &set);

    void
    insert(DeclaredKey declared, const Setter &set);

    /// Of a path; the number of entries if it is not declared.
    std::size_t
    index_of(const std::string &path) const;

    std::vector<std::string> subsections; ///< the present one
    std::vector<Entry>       entries;
  };

  /// All keys and values in force as a .prm; with documentation, default and
  /// allowed values as comments where `documented`.
  void
  print_keys(std::ostream &out, const std::vector<DeclaredKey> &keys, bool documented);

  template <typename Enum>
  void
  KeyTable::add(const std::string     &key,
                Enum                  &value,
                const EnumTable<Enum> &table,
                const std::string     &documentation)
  {
    std::vector<std::string> names;
    for (const auto &entry : table)
      names.push_back(entry.second);
    add_choice(key, enum_name(value, table), names, documentation,
               [&value, &table](const std::string &text)
               {
                 for (const auto &[entry, name] : table)
                   if (name == text)
                   {
                     value = entry;
                     return true;
                   }
                 return false;
               });
  }
} // namespace Exemplar

#endif
