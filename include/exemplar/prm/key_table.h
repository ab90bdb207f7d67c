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
  /// Exception for an undeclared key, as opposed to a value that is not allowed.
  class UnknownKey : public UserError
  {
    using UserError::UserError;
  };

  /// The names of an enum's values in scene files and in messages.
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

  /// The interval of allowed numbers, bounds included.
  struct Bounds
  {
    double low  = std::numeric_limits<double>::lowest();
    double high = std::numeric_limits<double>::max();

    /// Positive numbers; 0 is excluded by a tiny lower bound.
    static Bounds
    positive()
    {
      return { 1e-300 };
    }
  };

  /// A declared key: its path, value and allowed values.
  struct DeclaredKey
  {
    std::vector<std::string> subsections;
    std::string              key;
    std::string              value; ///< as set, else the default
    std::string              default_value;
    std::string              documentation;
    std::string              allowed;               ///< in words
    bool                     is_input_file = false; ///< of one file, or of a list of files
    bool                     is_list       = false; ///< values separated by commas
    std::string              separator     = ", ";  ///< between entries, if there are several

    std::string
    path() const;
  };

  /// The keys of a file, each bound to a variable to which its value is written. The variable's
  /// content at declaration is the default. Variables must keep their addresses.
  class KeyTable
  {
  public:
    KeyTable()                 = default;
    KeyTable(const KeyTable &) = delete;
    KeyTable &
    operator=(const KeyTable &)
        = delete;

    /// Declare the following keys in a subsection of the present one.
    void
    enter_subsection(const std::string &name);

    void
    leave_subsection();

    void
    add(const std::string &key,
        double            &value,
        const std::string &documentation,
        const Bounds      &bounds = {});

    /// Declare an unsigned integer.
    void
    add(const std::string &key,
        unsigned int      &value,
        const std::string &documentation,
        const Bounds      &bounds);

    void
    add(const std::string &key, bool &value, const std::string &documentation);

    /// Declare a text, which may have several entries.
    void
    add(const std::string &key,
        std::string       &value,
        const std::string &documentation,
        const std::string &separator = ", ");

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

    /// Declare a choice among the names of a table, which must outlive this.
    template <typename Enum>
    void
    add(const std::string     &key,
        Enum                  &value,
        const EnumTable<Enum> &table,
        const std::string     &documentation);

    /// Declare a list of names separated by commas.
    void
    add_names(const std::string        &key,
              std::vector<std::string> &value,
              const std::string        &documentation);

    /// Declare a list of one or more of `names`, each at most once, separated by commas.
    void
    add_choices(const std::string              &key,
                std::vector<std::string>       &value,
                const std::vector<std::string> &names,
                const std::string              &documentation);

    /// Declare the name of an input file.
    void
    add_file(const std::string &key, std::string &value, const std::string &documentation);

    /// Declare a list of names of input files, separated by commas.
    void
    add_files(const std::string        &key,
              std::vector<std::string> &value,
              const std::string        &documentation);

    /// All keys, those of a subsection together, in order of declaration.
    std::vector<DeclaredKey>
    keys() const;

    /// Whether a key of this path ("Section/Key") is declared.
    bool
    declares(const std::string &path) const;

    /// The text of a declared key's value, by its path "Section/Key".
    const std::string &
    get(const std::string &path) const;

    /// Set a declared key to a text, which must be allowed.
    void
    set(const std::string &path, const std::string &text);

    /// Set values; names of input files are made absolute relative to `directory`, unless that is
    /// empty. Throws UnknownKey for an undeclared key (with the nearest declared ones) and
    /// UserError for a value that is not allowed.
    void
    apply(const std::vector<Assignment> &assignments, const std::filesystem::path &directory);

  private:
    /// Parse a text and write it to a variable; returns false if it is not allowed.
    using Setter = std::function<bool(const std::string &)>;

    /// A key and its setter.
    struct Entry
    {
      DeclaredKey declared;
      Setter      set;
    };

    template <typename Value, typename Pattern>
    void
    add_pattern(DeclaredKey    declared,
                Value         &value,
                const Pattern &pattern,
                bool           takes_semicolons = false);

    void
    add_choice(const std::string              &key,
               const std::string              &name,
               const std::vector<std::string> &names,
               const std::string              &documentation,
               const Setter                   &set);

    void
    insert(DeclaredKey declared, const Setter &set);

    /// Index of a path in `entries`; their number if it is not declared.
    std::size_t
    index_of(const std::string &path) const;

    std::vector<std::string> subsections; ///< path of the present one
    std::vector<Entry>       entries;
  };

  /// Print all keys and values in force as a .prm, if `documented` with documentation, default and
  /// allowed values as comments.
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
