// Writes and reads NetCDF files in the classic formats; reads NetCDF-4 as well.
#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>

#include <hexhex/error.hpp>

#include <io/core/bytes.hpp>
#include <io/formats/netcdf.hpp>

namespace hexhex::io {

namespace {

constexpr std::uint64_t aligned(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

std::uint64_t bytesInFile(const NetcdfFile& file, const NetcdfVariable& variable) {
  std::uint64_t bytes = variable.type == NetcdfType::Char     ? 1
                        : variable.type == NetcdfType::Double ? 8
                                                              : 4;
  for (const std::uint32_t place : variable.dimensions) bytes *= file.dimensions[place].length;
  return bytes;
}

/// Builds the header of a file.
struct NetcdfHead {
  bool wide;  ///< counts take 8 bytes instead of 4
  std::string bytes;

  template <class T>
  void add(T number) {
    std::array<char, sizeof(T)> big{};
    bytes.append(big.data(), putBigBytes(big.data(), number));
  }
  void addCount(std::uint64_t count) { wide ? add(count) : add(static_cast<std::uint32_t>(count)); }
  void addText(std::string_view text) {
    addCount(text.size());
    bytes += text;
    bytes.resize(aligned(bytes.size()));
  }
  void beginList(std::uint32_t tag, std::size_t length) {
    add(length == 0 ? 0 : tag);
    addCount(length);
  }

  template <class T>
  void addValue(const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      add(NetcdfType::Char);
      return addText(value);
    } else {
      add(std::is_same_v<T, float> ? NetcdfType::Float : NetcdfType::Int);
      addCount(1);
      add(value);
    }
  }
  void addAttributes(const std::vector<NetcdfAttribute>& attributes) {
    beginList(12, attributes.size());
    for (const NetcdfAttribute& attribute : attributes) {
      addText(attribute.name);
      std::visit([this](const auto& value) { addValue(value); }, attribute.value);
    }
  }
};

/// @param begin  position of the values
std::string headOf(const NetcdfFile& file, bool wide, std::uint64_t begin) {
  NetcdfHead head{wide, wide ? "CDF\5" : "CDF\2"};
  head.addCount(0);  // records
  head.beginList(10, file.dimensions.size());
  for (const NetcdfDimension& dimension : file.dimensions) {
    head.addText(dimension.name);
    head.addCount(dimension.length);
  }
  head.addAttributes(file.attributes);
  head.beginList(11, file.variables.size());
  // The file has no records, but NetCDF requires their position to be after everything else.
  std::uint64_t records = begin;
  for (const NetcdfVariable& variable : file.variables) {
    records += aligned(bytesInFile(file, variable));
  }
  for (const NetcdfVariable& variable : file.variables) {
    head.addText(variable.name);
    head.addCount(variable.dimensions.size());
    for (const std::uint32_t place : variable.dimensions) head.addCount(place);
    head.addAttributes(variable.attributes);
    head.add(variable.type);
    const std::uint64_t bytes = aligned(bytesInFile(file, variable));
    head.addCount(bytes);
    head.add(bytes == 0 ? records : begin);
    begin += bytes;
  }
  return std::move(head.bytes);
}

/// Whether the file needs the layout with 64-bit sizes.
bool isWide(const NetcdfFile& file, std::uint64_t mostBytes) {
  return std::any_of(
      file.variables.begin(), file.variables.end(),
      [&](const NetcdfVariable& variable) { return bytesInFile(file, variable) > mostBytes; });
}

}  // namespace

std::uint64_t NetcdfFile::positionOf(std::string_view name, std::uint64_t mostBytes) const {
  std::uint64_t position = headOf(*this, isWide(*this, mostBytes), 0).size();
  for (const NetcdfVariable& variable : variables) {
    if (variable.name == name) break;
    position += aligned(bytesInFile(*this, variable));
  }
  return position;
}

void NetcdfFile::write(OutputFile& output, int threads, std::uint64_t mostBytes) const {
  const bool wide = isWide(*this, mostBytes);
  output.write(headOf(*this, wide, headOf(*this, wide, 0).size()));
  LineWriter values(output, threads);
  for (const NetcdfVariable& variable : variables) {
    if (variable.write != nullptr) variable.write(values);
    const std::uint64_t bytes = bytesInFile(*this, variable);
    output.write(std::string(aligned(bytes) - bytes, '\0'));
  }
}

namespace {

// Type codes, and the bytes of a value by type.
constexpr std::uint32_t kChar = 2;
constexpr std::array<std::uint8_t, 12> kNetcdfBytes = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};

/// Reads the header front to back.
class NetcdfHeadReader {
 public:
  NetcdfHeadReader(std::string_view bytes, const std::string& fileName)
      : bytes_(bytes), cursor_(bytes, bytes, fileName) {
    requireNetcdf(bytes, fileName);
    wideCounts_ = bytes[3] == 5;
    widePlaces_ = bytes[3] != 1;
    take(4);
  }

  std::vector<NetcdfValues> read() {
    static_cast<void>(count());  // number of records
    const std::uint64_t dimensions = beginList(10);
    for (std::uint64_t i = 0; i < dimensions; ++i) {
      static_cast<void>(text());
      lengths_.push_back(count());
    }
    static_cast<void>(attributes());
    std::vector<NetcdfValues> variables;
    const std::uint64_t all = beginList(11);
    for (std::uint64_t i = 0; i < all; ++i) variables.push_back(variable());
    return variables;
  }

 private:
  [[noreturn]] void fail(const char* sentence) const {
    cursor_.fail(ErrorCode::FileSyntax, sentence);
  }
  const char* take(std::uint64_t size) { return cursor_.take(size, "the head").data(); }
  std::uint32_t word() { return loadBig<std::uint32_t>(take(4)); }
  std::uint64_t wide() { return loadBig<std::uint64_t>(take(8)); }
  std::uint64_t count() { return wideCounts_ ? wide() : word(); }
  void skipPadding() { take((4 - cursor_.position() % 4) % 4); }
  std::string_view text() {
    const std::uint64_t size = count();
    const std::string_view result(take(size), static_cast<std::size_t>(size));
    skipPadding();
    return result;
  }
  /// @return the number of entries
  std::uint64_t beginList(std::uint32_t tag) {
    const std::uint32_t found = word();
    const std::uint64_t length = count();
    if (found != tag && (found != 0 || length != 0)) fail("a list has a wrong mark.");
    return length;
  }
  std::uint64_t bytesOf(std::uint32_t type) const {
    if (type == 0 || type >= kNetcdfBytes.size()) fail("values are of an unknown type.");
    return kNetcdfBytes[type];
  }
  /// @return the value of "elem_type", the type of elements
  std::string attributes() {
    std::string elementType;
    const std::uint64_t all = beginList(12);
    for (std::uint64_t i = 0; i < all; ++i) {
      const std::string_view name = text();
      const std::uint32_t type = word();
      const std::uint64_t size = bytesOf(type);
      const std::uint64_t length = count();
      if (length > bytes_.size()) fail("an attribute is longer than the file.");
      const std::string_view value(take(length * size), static_cast<std::size_t>(length * size));
      skipPadding();
      if (name == "elem_type" && type == kChar) elementType = value.substr(0, value.find('\0'));
    }
    return elementType;
  }
  NetcdfValues variable() {
    NetcdfValues variable;
    variable.name = text();
    const std::uint64_t dimensions = count();
    variable.count = 1;
    for (std::uint64_t i = 0; i < dimensions; ++i) {
      const std::uint64_t dimension = count();
      if (dimension >= lengths_.size()) fail("a variable has a dimension that does not exist.");
      // Length 0 marks the record dimension, used for results.
      const std::uint64_t length = lengths_[static_cast<std::size_t>(dimension)];
      variable.lengths.push_back(length);
      if (length > 0 && variable.count > bytes_.size() / length) {
        fail("a variable has more values than the file has bytes.");
      }
      variable.count *= length;
    }
    variable.elementType = attributes();
    variable.type = word();
    const std::uint64_t each = bytesOf(variable.type);
    static_cast<void>(count());
    variable.begin = widePlaces_ ? wide() : word();
    const bool fits =
        variable.begin <= bytes_.size() && variable.count * each <= bytes_.size() - variable.begin;
    if (variable.count > 0 && !fits) fail("the file ends within the values of a variable.");
    // Otherwise many variables that share the same values could take far more memory than the file.
    valueBytes_ += variable.count * each;
    if (valueBytes_ > bytes_.size()) fail("variables have more values than the file has bytes.");
    return variable;
  }

  std::string_view bytes_;
  ByteCursor cursor_;
  bool wideCounts_ = false;
  bool widePlaces_ = false;
  std::uint64_t valueBytes_ = 0;  ///< of the variables so far
  std::vector<std::uint64_t> lengths_;
};

void sortByName(std::vector<NetcdfValues>& variables) {
  std::sort(variables.begin(), variables.end(),
            [](const NetcdfValues& a, const NetcdfValues& b) { return a.name < b.name; });
}

}  // namespace

void requireNetcdf(std::string_view head, const std::string& fileName) {
  const bool known =
      head.size() > 4 && head.starts_with("CDF") && (head[3] == 1 || head[3] == 2 || head[3] == 5);
  if (!known) {
    throw Error(ErrorCode::FileSyntax,
                fileName +
                    ": the file does not begin as NetCDF's files do. Is its extension "
                    "right?");
  }
}

NetcdfReader::NetcdfReader(std::string_view bytes, const std::string& fileName)
    : bytes_(bytes), fileName_(fileName), variables_(NetcdfHeadReader(bytes, fileName).read()) {
  sortByName(variables_);
}

NetcdfReader::NetcdfReader(std::unique_ptr<HdfReader> file, const std::string& fileName)
    : hdf_(std::move(file)), fileName_(fileName) {
  for (const std::string& name : hdf_->members("/")) {
    if (!hdf_->has(name)) continue;
    // A dimension is stored as a dataset, too.
    if (hdf_->attribute(name, "NAME").starts_with("This is a netCDF dimension")) continue;
    NetcdfValues& values = variables_.emplace_back();
    values.name = name;
    values.lengths = hdf_->shape(name);
    values.elementType = hdf_->attribute(name, "elem_type");
    values.count = 1;
    for (const std::uint64_t length : values.lengths) values.count *= length;
  }
  sortByName(variables_);
}

const NetcdfValues* NetcdfReader::find(std::string_view name) const {
  const auto found =
      std::lower_bound(variables_.begin(), variables_.end(), name,
                       [](const NetcdfValues& a, std::string_view b) { return a.name < b; });
  if (found == variables_.end() || found->name != name) return nullptr;
  if (hdf_ != nullptr) hdf_->requireStored(found->name);
  return &*found;
}

const NetcdfValues& NetcdfReader::get(std::string_view name) const {
  const NetcdfValues* const found = find(name);
  if (found != nullptr) return *found;
  throw Error(ErrorCode::FileSyntax,
              concat(fileName_, ": the file lacks the variable \"", name, "\"."));
}

template <class Narrow, class Number>
std::vector<Number> NetcdfReader::numbers(const NetcdfValues& values, std::uint32_t narrow,
                                          std::uint32_t wide, const char* what) const {
  if (values.type != narrow && values.type != wide) {
    throw Error(ErrorCode::FileSyntax,
                concat(fileName_, ": the variable \"", values.name, "\" has no ", what, "."));
  }
  std::vector<Number> numbers(static_cast<std::size_t>(values.count));
  const char* place = bytes_.data() + values.begin;
  for (Number& number : numbers) {
    number = values.type == narrow ? Number{loadBig<Narrow>(place)} : loadBig<Number>(place);
    place += kNetcdfBytes[values.type];
  }
  return numbers;
}

std::vector<std::int64_t> NetcdfReader::integers(const NetcdfValues& values) const {
  if (hdf_ != nullptr) return hdf_->integers(values.name);
  return numbers<std::int32_t, std::int64_t>(values, 4, 10, "integers of 32 or 64 bits");
}

std::vector<double> NetcdfReader::reals(const NetcdfValues& values) const {
  if (hdf_ != nullptr) return hdf_->reals(values.name);
  return numbers<float, double>(values, 5, 6, "floating-point numbers");
}

std::vector<std::string> NetcdfReader::texts(const NetcdfValues& values) const {
  std::vector<std::string> texts;
  const bool areTexts = hdf_ != nullptr || values.type == kChar;
  if (!areTexts || values.lengths.size() != 2 || values.count == 0) return texts;
  const std::string own = hdf_ != nullptr ? hdf_->text(values.name) : std::string();
  const std::string_view all = hdf_ != nullptr
                                   ? own
                                   : bytes_.substr(static_cast<std::size_t>(values.begin),
                                                   static_cast<std::size_t>(values.count));
  const auto width = static_cast<std::size_t>(values.lengths[1]);
  for (std::size_t begin = 0; begin < all.size(); begin += width) {
    const std::string_view row = all.substr(begin, width);
    texts.emplace_back(row.substr(0, row.find('\0')));
  }
  return texts;
}

}  // namespace hexhex::io
