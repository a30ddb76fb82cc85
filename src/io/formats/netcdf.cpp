// Writes and reads NetCDF files in the classic formats.
#include <algorithm>
#include <array>
#include <map>
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
constexpr std::uint32_t kInt = 4;
constexpr std::uint32_t kFloat = 5;
constexpr std::uint32_t kDouble = 6;
constexpr std::uint32_t kInt64 = 10;
constexpr std::string_view kElementType = "elem_type";
constexpr std::array<std::uint8_t, 12> kNetcdfBytes = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};

/// A variable of a file: position, type and shape of its values.
struct NetcdfValues {
  std::string name;
  std::uint32_t type = 0;  ///< type code of the format
  std::vector<std::uint64_t> lengths;
  std::string elementType;  ///< the attribute "elem_type"
  std::uint64_t count = 0;
  std::uint64_t begin = 0;
};

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
  /// @return the value of kElementType
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
      if (name == kElementType && type == kChar) elementType = value.substr(0, value.find('\0'));
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

class NetcdfReader final : public HdfReader {
 public:
  NetcdfReader(std::string_view bytes, const std::string& fileName)
      : bytes_(bytes), fileName_(fileName) {
    for (NetcdfValues& each : NetcdfHeadReader(bytes, fileName).read()) {
      variables_.emplace(each.name, std::move(each));
    }
  }

  [[nodiscard]] std::vector<std::string> members(const std::string& /*group*/) const override {
    std::vector<std::string> names;
    for (const auto& [name, values] : variables_) names.push_back(name);
    return names;
  }
  [[nodiscard]] bool has(const std::string& path) const override {
    return variables_.contains(path);
  }
  [[nodiscard]] std::vector<std::uint64_t> shape(const std::string& path) const override {
    return variables_.at(path).lengths;
  }
  [[nodiscard]] bool hasReals(const std::string& path) const override {
    return variables_.at(path).type == kFloat || variables_.at(path).type == kDouble;
  }
  void requireStored(const std::string& /*path*/) const override {}  // of all, with the header
  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& path) const override {
    return numbers<std::int32_t, std::int64_t>(path, kInt, kInt64, "integers of 32 or 64 bits");
  }
  [[nodiscard]] std::vector<double> reals(const std::string& path) const override {
    return numbers<float, double>(path, kFloat, kDouble, "floating-point numbers");
  }
  [[nodiscard]] std::string text(const std::string& path) const override {
    const NetcdfValues& values = variables_.at(path);
    if (values.type != kChar) return {};
    return std::string(bytes_.substr(static_cast<std::size_t>(values.begin),
                                     static_cast<std::size_t>(values.count)));
  }
  [[nodiscard]] std::string attribute(const std::string& path, const char* name) const override {
    return name == kElementType ? variables_.at(path).elementType : std::string();
  }

 private:
  /// The numbers of a variable of one of two types, of 32 and of 64 bits.
  template <class Narrow, class Number>
  [[nodiscard]] std::vector<Number> numbers(const std::string& path, std::uint32_t narrow,
                                            std::uint32_t wide, const char* what) const {
    const NetcdfValues& values = variables_.at(path);
    if (values.type != narrow && values.type != wide) {
      throw Error(ErrorCode::FileSyntax,
                  concat(fileName_, ": the variable \"", path, "\" has no ", what, "."));
    }
    std::vector<Number> numbers(static_cast<std::size_t>(values.count));
    const char* place = bytes_.data() + values.begin;
    for (Number& number : numbers) {
      number = values.type == narrow ? Number{loadBig<Narrow>(place)} : loadBig<Number>(place);
      place += kNetcdfBytes[values.type];
    }
    return numbers;
  }

  std::string_view bytes_;
  const std::string& fileName_;
  std::map<std::string, NetcdfValues> variables_;
};

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

std::unique_ptr<HdfReader> openNetcdf(std::string_view bytes, const std::string& fileName) {
  return std::make_unique<NetcdfReader>(bytes, fileName);
}

}  // namespace hexhex::io
