// One table for each struct that a person fills in: parameters, lights, cameras, run configs.
//
// A field is declared once (member, name, range, unit, meaning, binding). From the table come JSON reading with all errors
// at once, JSON writing, the JSON Schema, `describe`, sweeps, viewer keys, and the uniform block that shaders see.
// This header is free of JSON so that plugins compile fast; json.h works on tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace gnomon {

class Problems;

/// How a change of a parameter takes effect.
enum class Binding : std::uint8_t {
  structure,   ///< the technique is set up again
  specialise,  ///< a constant compiled into shaders
  uniform      ///< a value in the generated uniform block
};

/// The C++ type behind a field, which fixes its JSON form.
enum class FieldType : std::uint8_t {
  boolean,  ///< bool              true | false
  integer,  ///< int               7
  real32,   ///< float             0.5
  real64,   ///< double            0.5
  choice,   ///< enum (int based)  "box": index in `choices` is the value
  text,     ///< std::string       "..."
  size,     ///< glm::ivec2        1024 (square) or [1080, 2220]
  vector2,  ///< glm::dvec2        [x, y]
  vector3,  ///< glm::dvec3        [x, y, z]
  object,   ///< struct with its own table
  list,     ///< std::vector of structs with a table, or of text (free, or names out of `choices`, none twice)
  custom    ///< read and described by functions (json.h: CustomField)
};

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string unit = {};
  bool openMin = false;      ///< min itself is not allowed
  int step = 0;              ///< of integers and sizes: only multiples of it are allowed; 0 or 1: all
  bool odd = false;          ///< of integers and sizes: only odd ones are allowed
  bool logarithmic = false;  ///< of reals above 0: a person steps by factors, not by differences
};

/// Whether an integer or one side of a size may have this value.
bool allowsInteger(const Range& range, double value);
/// From one allowed integer to the next: `step`, twice that where only odd ones are allowed.
int integerStep(const Range& range);

class FieldTable;
struct CustomField;  // json.h

struct Field {
  std::string name;
  FieldType type = FieldType::boolean;
  std::string meaning;
  Range range;
  std::vector<std::string> choices;  ///< of FieldType::choice, and of a list of names
  Binding binding = Binding::structure;
  bool required = false;

  /// The value inside an object; null where it is an empty optional.
  std::function<const void*(const void*)> find;
  /// The value inside an object, created where it is an empty optional.
  std::function<void*(void*)> make;
  /// Gives the first object's member the second's value.
  std::function<void(void*, const void*)> assign;

  std::shared_ptr<const FieldTable> nested;  ///< of object, and of list (null: a list of text)
  std::shared_ptr<const void> blank;         ///< default-constructed: an object, or an element of a list (for schemas)
  std::function<void(void*)> clear;          ///< of list
  std::function<void*(void*)> append;        ///< of list: adds a default element, returns it
  std::function<std::size_t(const void*)> count;
  std::function<const void*(const void*, std::size_t)> element;
  std::shared_ptr<const CustomField> custom;

  Field&& mandatory() && {
    required = true;
    return std::move(*this);
  }
  /// Of a list of text: each must be one of these.
  Field&& among(std::vector<std::string> names) && {
    choices = std::move(names);
    return std::move(*this);
  }
};

/// Where a value was read, for messages.
struct Location {
  std::string file;
  std::string pointer;         ///< JSON pointer
  std::string keyPrefix = {};  ///< before the key of a child: how the check of an inlined struct finds its flat keys

  /// The member `key` of the object here; `/` and `~` in it are escaped as JSON pointers want.
  Location child(const std::string& key) const;
  Location child(std::size_t index) const { return {file, pointer + "/" + std::to_string(index)}; }
};

/// The type-erased table. `check` sees the whole object after its fields were read without error.
class FieldTable {
 public:
  using Check = std::function<void(const void*, const Location&, Problems&)>;

  FieldTable() = default;
  explicit FieldTable(std::vector<Field> fields, Check check = {}) : fields_(std::move(fields)), check_(std::move(check)) {}

  const std::vector<Field>& fields() const { return fields_; }
  const Field* find(const std::string& name) const;
  std::vector<std::string> names() const;
  const Check& check() const { return check_; }

 private:
  std::vector<Field> fields_;
  Check check_;
};

/// "an integer from 1 to 31 texels", "one of box, gaussian": what a person may write for the field. Empty for custom fields.
std::string allowedText(const Field& field);

/// The value of the field in `object`, as JSON without the quotes of text ("5", "box", "[1080,2220]"); "none" if it is empty.
std::string valueText(const Field& field, const void* object);

/// Gives `to` the value that `from` has, of any type; both are objects with the field.
void copyValue(const Field& field, void* to, const void* from);
void copyValues(const FieldTable& table, void* to, const void* from);
/// Whether two objects agree in the field. Two custom values count as different: nothing is known of them.
bool equalValue(const Field& field, const void* a, const void* b);
bool equalValues(const FieldTable& table, const void* a, const void* b);

/// One field, or the fields of an inlined struct with their check.
class Fields {
 public:
  Fields(Field field) { list_.push_back(std::move(field)); }  // NOLINT(google-explicit-constructor)
  explicit Fields(std::vector<Field> fields, FieldTable::Check check = {})
      : list_(std::move(fields)), check_(std::move(check)) {}
  const std::vector<Field>& list() const { return list_; }
  const FieldTable::Check& check() const { return check_; }

 private:
  std::vector<Field> list_;
  FieldTable::Check check_;
};

/// The table of T: what each technique and each configurable struct returns.
template <class T>
class ParameterTable {
 public:
  ParameterTable(std::initializer_list<Fields> fields) {
    for (const Fields& some : fields) {
      fields_.insert(fields_.end(), some.list().begin(), some.list().end());
      if (some.check()) addCheck(some.check());
    }
  }
  /// Adds a check of the whole object; it runs after those of inlined structs.
  ParameterTable&& checked(std::function<void(const T&, const Location&, Problems&)> check) && {
    addCheck([check = std::move(check)](const void* object, const Location& where, Problems& problems) {
      check(*static_cast<const T*>(object), where, problems);
    });
    return std::move(*this);
  }
  std::shared_ptr<const FieldTable> table() const { return std::make_shared<const FieldTable>(fields_, check_); }
  const std::vector<Field>& fields() const { return fields_; }
  const FieldTable::Check& check() const { return check_; }

 private:
  void addCheck(FieldTable::Check next) {
    if (!check_) {
      check_ = std::move(next);
      return;
    }
    check_ = [first = std::move(check_), second = std::move(next)](const void* object, const Location& where,
                                                                   Problems& problems) {
      first(object, where, problems);
      second(object, where, problems);
    };
  }

  std::vector<Field> fields_;
  FieldTable::Check check_;
};

namespace detail {
template <class V>
struct Unwrapped {
  using Type = V;
  static constexpr bool optional = false;
};
template <class V>
struct Unwrapped<std::optional<V>> {
  using Type = V;
  static constexpr bool optional = true;
};

template <class V>
constexpr FieldType fieldTypeOf() {
  using B = std::remove_cv_t<V>;
  if constexpr (std::is_same_v<B, bool>)
    return FieldType::boolean;
  else if constexpr (std::is_same_v<B, int>)
    return FieldType::integer;
  else if constexpr (std::is_same_v<B, float>)
    return FieldType::real32;
  else if constexpr (std::is_same_v<B, double>)
    return FieldType::real64;
  else if constexpr (std::is_same_v<B, std::string>)
    return FieldType::text;
  else if constexpr (std::is_same_v<B, glm::ivec2>)
    return FieldType::size;
  else if constexpr (std::is_same_v<B, glm::dvec2>)
    return FieldType::vector2;
  else if constexpr (std::is_same_v<B, glm::dvec3>)
    return FieldType::vector3;
  else if constexpr (std::is_enum_v<B>)
    return FieldType::choice;
  else
    return FieldType::object;
}

template <class T, class V>
Field makeField(std::string name, V T::*member, std::string meaning) {
  Field field;
  field.name = std::move(name);
  field.meaning = std::move(meaning);
  field.type = fieldTypeOf<typename Unwrapped<V>::Type>();
  field.find = [member](const void* object) -> const void* {
    const V& value = static_cast<const T*>(object)->*member;
    if constexpr (Unwrapped<V>::optional)
      return value ? &*value : nullptr;
    else
      return &value;
  };
  field.make = [member](void* object) -> void* {
    V& value = static_cast<T*>(object)->*member;
    if constexpr (Unwrapped<V>::optional) {
      if (!value) value.emplace();
      return &*value;
    } else {
      return &value;
    }
  };
  field.assign = [member](void* to, const void* from) { static_cast<T*>(to)->*member = static_cast<const T*>(from)->*member; };
  return field;
}
}  // namespace detail

/// Members may be plain or std::optional; an optional that JSON does not name stays empty.
template <class T, class V>
Field boolean(std::string name, V T::*member, Binding binding, std::string meaning) {
  Field field = detail::makeField(std::move(name), member, std::move(meaning));
  field.binding = binding;
  return field;
}
template <class T, class V>
Field integer(std::string name, V T::*member, Range range, Binding binding, std::string meaning) {
  Field field = boolean(std::move(name), member, binding, std::move(meaning));
  field.range = std::move(range);
  return field;
}
/// float or double.
template <class T, class V>
Field real(std::string name, V T::*member, Range range, Binding binding, std::string meaning) {
  return integer(std::move(name), member, std::move(range), binding, std::move(meaning));
}
/// glm::ivec2, written as one number (square) or two; the range holds for each.
template <class T, class V>
Field size(std::string name, V T::*member, Range range, Binding binding, std::string meaning) {
  return integer(std::move(name), member, std::move(range), binding, std::move(meaning));
}
/// An enum whose values 0, 1, ... are named by `choices`.
template <class T, class V>
Field choice(std::string name, V T::*member, std::vector<std::string> choices, Binding binding, std::string meaning) {
  static_assert(sizeof(typename detail::Unwrapped<V>::Type) == sizeof(int), "choice enums are int based");
  Field field = boolean(std::move(name), member, binding, std::move(meaning));
  field.choices = std::move(choices);
  return field;
}
template <class T, class V>
Field text(std::string name, V T::*member, std::string meaning) {
  return detail::makeField(std::move(name), member, std::move(meaning));
}
/// glm::dvec2 or glm::dvec3; the range holds for each component.
template <class T, class V>
Field vector(std::string name, V T::*member, Range range, std::string meaning) {
  Field field = detail::makeField(std::move(name), member, std::move(meaning));
  field.range = std::move(range);
  return field;
}
template <class T, class V>
Field object(std::string name, V T::*member, std::shared_ptr<const FieldTable> nested, std::string meaning) {
  Field field = detail::makeField(std::move(name), member, std::move(meaning));
  field.nested = std::move(nested);
  field.blank = std::make_shared<const typename detail::Unwrapped<V>::Type>();
  return field;
}
/// std::vector<Struct> with a table, or std::vector<std::string> with none.
template <class T, class V>
Field list(std::string name, V T::*member, std::shared_ptr<const FieldTable> nested, std::string meaning) {
  using List = typename detail::Unwrapped<V>::Type;
  using Element = typename List::value_type;
  Field field = detail::makeField(std::move(name), member, std::move(meaning));
  field.type = FieldType::list;
  field.nested = std::move(nested);
  field.blank = std::make_shared<const Element>();
  field.clear = [](void* values) { static_cast<List*>(values)->clear(); };
  field.append = [](void* values) -> void* { return &static_cast<List*>(values)->emplace_back(); };
  field.count = [](const void* values) { return static_cast<const List*>(values)->size(); };
  field.element = [](const void* values, std::size_t i) -> const void* { return &(*static_cast<const List*>(values))[i]; };
  return field;
}
/// Anything else: json.h's CustomField says how it is read, written and described.
template <class T, class V>
Field custom(std::string name, V T::*member, std::shared_ptr<const CustomField> how, std::string meaning) {
  Field field = detail::makeField(std::move(name), member, std::move(meaning));
  field.type = FieldType::custom;
  field.custom = std::move(how);
  return field;
}
/// The fields of a member struct as fields of the outer one, their names behind `prefix`: flat keys such as "bias.slope".
/// The inner table's check runs too, on the member.
template <class T, class V>
Fields inlined(V T::*member, const ParameterTable<V>& inner, const std::string& prefix = {}) {
  std::vector<Field> fields = inner.fields();
  for (Field& field : fields) {
    field.name = prefix + field.name;
    field.find = [member, find = field.find](const void* object) { return find(&(static_cast<const T*>(object)->*member)); };
    field.make = [member, make = field.make](void* object) { return make(&(static_cast<T*>(object)->*member)); };
    field.assign = [member, assign = field.assign](void* to, const void* from) {
      assign(&(static_cast<T*>(to)->*member), &(static_cast<const T*>(from)->*member));
    };
  }
  FieldTable::Check check;
  if (inner.check()) {
    check = [member, prefix, inside = inner.check()](const void* object, const Location& where, Problems& problems) {
      inside(&(static_cast<const T*>(object)->*member), {where.file, where.pointer, where.keyPrefix + prefix}, problems);
    };
  }
  return Fields(std::move(fields), std::move(check));
}

}  // namespace gnomon
