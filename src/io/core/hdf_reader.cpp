#include <algorithm>
#include <array>
#include <limits>

#include <hexhex/error.hpp>

#include <base/concat.hpp>
#include <io/core/compressed_blocks.hpp>
#include <io/core/hdf_file.hpp>
#include <io/core/hdf_reader.hpp>

namespace hexhex::io {

namespace {

class OpenHdf final : public HdfReader {
 public:
  explicit OpenHdf(const Input& input)
      : target_{.name = input.name()},
        access_(target_, HDF5(H5Pcreate)(HDF5(H5P_CLS_FILE_ACCESS_ID_g)), HDF5(H5Pclose)),
        links_(target_, HDF5(H5Pcreate)(HDF5(H5P_CLS_LINK_ACCESS_ID_g)), HDF5(H5Pclose)),
        file_(target_, openFile(input), HDF5(H5Fclose)) {
    // External links are refused, however indirectly a path reaches them.
    const H5L_elink_traverse_t refuse = [](const char*, const char*, const char*, const char*,
                                           unsigned*, hid_t, void*) -> herr_t { return -1; };
    links_.require(HDF5(H5Pset_elink_cb)(links_.id(), refuse, nullptr));
  }

  [[nodiscard]] std::vector<std::string> members(const std::string& path) const override {
    const HdfObject group = open(path);
    H5G_info_t info{};
    group.require(HDF5(H5Gget_info)(group.id(), &info));
    std::vector<std::string> names;
    for (const H5_index_t index : {H5_INDEX_CRT_ORDER, H5_INDEX_NAME}) {
      for (hsize_t i = 0; i < info.nlinks; ++i) {
        const auto read = [&](char* to, std::size_t size) {
          return HDF5(H5Lget_name_by_idx)(group.id(), ".", index, H5_ITER_INC, i, to, size,
                                          H5P_DEFAULT);
        };
        const auto length = read(nullptr, 0);
        if (length < 0 && index == H5_INDEX_CRT_ORDER) break;
        target_.require(length);
        std::string& name = names.emplace_back(static_cast<std::size_t>(length), '\0');
        target_.require(read(name.data(), name.size() + 1));
      }
      if (names.size() == info.nlinks) break;
      names.clear();
    }
    return names;
  }

  [[nodiscard]] bool has(const std::string& path) const override {
    for (std::size_t end = path.find('/');; end = path.find('/', end + 1)) {
      const std::string part = path.substr(0, end);
      if (HDF5(H5Lexists)(file_.id(), part.c_str(), links_.id()) <= 0) return false;
      if (end == std::string::npos) break;
    }
    const hid_t object = HDF5(H5Oopen)(file_.id(), path.c_str(), links_.id());
    if (object < 0) return false;  // a dangling link
    const HdfObject opened(target_, object, HDF5(H5Oclose));
    return HDF5(H5Iget_type)(object) == H5I_DATASET;
  }

  [[nodiscard]] std::vector<std::uint64_t> shape(const std::string& path) const override {
    return Dataset(*this, path).shape;
  }

  void requireStored(const std::string& path) const override {
    static_cast<void>(Dataset(*this, path).count(*this, path));
  }

  [[nodiscard]] bool hasReals(const std::string& path) const override {
    return Dataset(*this, path).kind == H5T_FLOAT;
  }

  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& path) const override {
    return numbers<std::int64_t>(path, H5T_INTEGER, HDF5(H5T_NATIVE_INT64_g), "integers");
  }

  [[nodiscard]] std::vector<double> reals(const std::string& path) const override {
    return numbers<double>(path, H5T_FLOAT, HDF5(H5T_NATIVE_DOUBLE_g), "floating-point numbers");
  }

  [[nodiscard]] std::string text(const std::string& path) const override {
    const Dataset set(*this, path);
    const bool isBytes = set.kind == H5T_INTEGER && set.each == 1;
    if (!isBytes && (set.kind != H5T_STRING || HDF5(H5Tis_variable_str)(set.type.id()) != 0)) {
      fail(path, "has no text.");
    }
    std::string bytes(set.count(*this, path) * set.each, '\0');
    if (!bytes.empty()) set.read(set.type.id(), bytes.data());
    return bytes;
  }

  [[nodiscard]] std::string attribute(const std::string& path, const char* name) const override {
    const HdfObject object = open(path);
    if (HDF5(H5Aexists)(object.id(), name) <= 0) return {};
    const HdfObject found(target_, HDF5(H5Aopen)(object.id(), name, H5P_DEFAULT), HDF5(H5Aclose));
    const HdfObject type(target_, HDF5(H5Aget_type)(found.id()), HDF5(H5Tclose));
    const HdfObject space(target_, HDF5(H5Aget_space)(found.id()), HDF5(H5Sclose));
    const hssize_t count = HDF5(H5Sget_simple_extent_npoints)(space.id());
    if (HDF5(H5Tget_class)(type.id()) != H5T_STRING || count < 1) return {};
    std::string text;
    if (HDF5(H5Tis_variable_str)(type.id()) > 0) {
      std::vector<char*> texts(static_cast<std::size_t>(count), nullptr);
      found.require(HDF5(H5Aread)(found.id(), type.id(), texts.data()));
      if (texts[0] != nullptr) text = texts[0];
      for (char* const each : texts) HDF5(H5free_memory)(each);
    } else {
      text.resize(static_cast<std::size_t>(count) * HDF5(H5Tget_size)(type.id()));
      found.require(HDF5(H5Aread)(found.id(), type.id(), text.data()));
    }
    return text.substr(0, text.find('\0'));
  }

 private:
  /// An open dataset, and what it holds.
  struct Dataset {
    Dataset(const OpenHdf& file, const std::string& path)
        : set(file.open(path)),
          type(file.target_, HDF5(H5Dget_type)(set.id()), HDF5(H5Tclose)),
          kind(HDF5(H5Tget_class)(type.id())),
          each(HDF5(H5Tget_size)(type.id())) {
      file.requireInside(set, path);
      const HdfObject space(file.target_, HDF5(H5Dget_space)(set.id()), HDF5(H5Sclose));
      const int rank = HDF5(H5Sget_simple_extent_ndims)(space.id());
      space.require(rank);
      std::vector<hsize_t> lengths(static_cast<std::size_t>(rank));
      space.require(HDF5(H5Sget_simple_extent_dims)(space.id(), lengths.data(), nullptr));
      shape.assign(lengths.begin(), lengths.end());
    }
    /// The number of values, checked against the bytes stored.
    [[nodiscard]] std::size_t count(const OpenHdf& file, const std::string& path) const {
      if (std::find(shape.begin(), shape.end(), 0U) != shape.end()) return 0;
      const std::uint64_t stored = HDF5(H5Dget_storage_size)(set.id());
      constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
      std::uint64_t room = std::min(stored, kMost / kLargestZlibRatio) * kLargestZlibRatio / each;
      std::size_t values = 1;
      for (const std::uint64_t length : shape) {
        if (length > room) file.fail(path, "has more values than the file has bytes for.");
        room /= length;
        values *= static_cast<std::size_t>(length);
      }
      return values;
    }
    void read(hid_t memory, void* to) const {
      set.require(HDF5(H5Dread)(set.id(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, to));
    }

    HdfObject set;
    HdfObject type;
    H5T_class_t kind;
    std::size_t each;  ///< bytes of a value
    std::vector<std::uint64_t> shape;
  };

  [[nodiscard]] HdfObject open(const std::string& path) const {
    return {target_, HDF5(H5Oopen)(file_.id(), path.c_str(), links_.id()), HDF5(H5Oclose)};
  }

  void requireInside(const HdfObject& set, const std::string& path) const {
    const HdfObject made(target_, HDF5(H5Dget_create_plist)(set.id()), HDF5(H5Pclose));
    if (HDF5(H5Pget_external_count)(made.id()) == 0 &&
        HDF5(H5Pget_layout)(made.id()) != H5D_VIRTUAL) {
      return;
    }
    fail(path, "has its values in another file. Save the mesh as one file.");
  }

  [[nodiscard]] hid_t openFile(const Input& input) const {
    if (!input.bytes()) return HDF5(H5Fopen)(input.path().c_str(), H5F_ACC_RDONLY, access_.id());
    constexpr std::size_t kStep = std::size_t{1} << 16;  // growth increment
    access_.require(HDF5(H5Pset_fapl_core)(access_.id(), kStep, false));
    // HDF5 copies the bytes, although it takes a pointer to non-const.
    std::string bytes(*input.bytes());
    access_.require(HDF5(H5Pset_file_image)(access_.id(), bytes.data(), bytes.size()));
    // HDF5 refuses the name of an existing file; no file can exist below a device.
    return HDF5(H5Fopen)("/dev/null/hexhex", H5F_ACC_RDONLY, access_.id());
  }

  [[noreturn]] void fail(const std::string& path, const std::string& sentence) const {
    throw Error(ErrorCode::FileSyntax, target_.name + ": \"" + path + "\" " + sentence);
  }

  template <class T>
  [[nodiscard]] std::vector<T> numbers(const std::string& path, H5T_class_t kind, hid_t memory,
                                       const char* what) const {
    const Dataset set(*this, path);
    if (set.kind != kind) fail(path, concat("has no ", what, '.'));
    std::vector<T> values(set.count(*this, path));
    if (!values.empty()) set.read(memory, values.data());
    return values;
  }

  HdfSession session_;
  HdfTarget target_;
  HdfObject access_;
  HdfObject links_;  ///< link access properties
  HdfObject file_;
};

}  // namespace

std::unique_ptr<HdfReader> HdfReader::open(const Input& input) {
  requireHdf5(input.name());
  return std::make_unique<OpenHdf>(input);
}

}  // namespace hexhex::io
