// HDF5 files written through OutputFile, and RAII wrappers that the reader shares (hdf_reader.cpp).
//
// HDF5 cannot close a file after a failed write, and crashes when the process ends. So the driver
// never reports a failed write: the error is stored and thrown by the next function of this header,
// and later writes are dropped.
#pragma once

#include <cstdint>
#include <exception>
#include <hdf5.h>
#include <initializer_list>
#include <mutex>
#include <string>
#include <utility>

#include <io/core/hdf_reader.hpp>
#include <io/core/output_file.hpp>

/// A function or global of the library: HDF5(H5Dwrite), HDF5(H5T_NATIVE_INT32_g).
#if defined(HEXHEX_HDF5_NAME)
#define HDF5(name)                                                                                 \
  (*[] {                                                                                           \
    static const auto symbol = reinterpret_cast<decltype(&::name)>(hexhex::io::hdf5Symbol(#name)); \
    return symbol;                                                                                 \
  }())
// HDF5's macros for constants expand to these, which initialize the library.
#undef H5OPEN
#undef H5CHECK
#define H5OPEN
#define H5CHECK
#else
#define HDF5(name) ::name
#endif

namespace hexhex::io {

/// The file that HDF5 writes or reads, and the first error there.
struct HdfTarget {
  const OutputFile* output = nullptr;  ///< null for a file that is read
  std::string name = {};               ///< of the file that is read
  std::exception_ptr failure = nullptr;

  /// Throws the stored error, or an error if the status is negative.
  /// @param status  returned by HDF5
  void require(std::int64_t status) const;
};

/// An open HDF5 object. Every function throws as HdfTarget::require() does.
class HdfObject {
 public:
  using Close = herr_t (*)(hid_t);
  HdfObject(const HdfTarget& target, hid_t id, Close function)
      : target_(target), id_(id), close_(function) {
    target_.require(id_);
  }
  ~HdfObject() {
    if (id_ >= 0) close_(id_);
  }
  HdfObject(HdfObject&& other) noexcept
      : target_(other.target_), id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  HdfObject(const HdfObject&) = delete;
  HdfObject& operator=(const HdfObject&) = delete;
  HdfObject& operator=(HdfObject&&) = delete;

  [[nodiscard]] hid_t id() const noexcept { return id_; }
  void require(herr_t status) const { target_.require(status); }
  /// Closes it now, so that an error on closing is thrown.
  void close();

 private:
  const HdfTarget& target_;
  hid_t id_;
  Close close_;
};

/// For its lifetime, no other thread uses HDF5 through this library, and HDF5 prints no errors.
class HdfSession {
 public:
  /// @throws std::bad_alloc
  HdfSession();
  ~HdfSession();
  HdfSession(const HdfSession&) = delete;
  HdfSession& operator=(const HdfSession&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// An HDF5 file being written. Its bytes depend only on the content, not on the time of writing.
class HdfFile {
 public:
  /// Whether groups store the creation order of their members, which takes a newer file layout.
  enum class Order : bool { OfNames, OfCreation };

  HdfFile(const OutputFile& output, Order order);
  ~HdfFile();
  HdfFile(const HdfFile&) = delete;
  HdfFile& operator=(const HdfFile&) = delete;

  [[nodiscard]] hid_t root() const noexcept { return file_.id(); }
  [[nodiscard]] HdfObject group(hid_t parent, const std::string& name) const;
  /// @param shape  empty: a scalar
  [[nodiscard]] HdfObject space(std::initializer_list<hsize_t> shape) const;
  [[nodiscard]] HdfObject dataset(hid_t parent, const std::string& name, hid_t type,
                                  const HdfObject& space) const;
  /// An extensible dataset without rows, to be filled by append().
  /// @param components  per row; 1 makes a one-dimensional dataset
  [[nodiscard]] HdfObject growing(hid_t parent, const std::string& name, hid_t type,
                                  hsize_t components) const;
  /// Appends rows to a dataset.
  /// @param rows  the current number of rows; updated
  void append(const HdfObject& set, hid_t memoryType, hsize_t components, hsize_t& rows,
              const void* values, hsize_t count) const;
  /// A contiguous dataset whose values are not written: the caller writes them itself.
  /// @return the position of the first value in the file
  [[nodiscard]] std::uint64_t reserve(hid_t parent, const std::string& name, hid_t type,
                                      hsize_t rows, hsize_t components) const;
  void writeAttribute(hid_t object, const char* name, hid_t type, const HdfObject& space,
                      const void* values) const;
  /// A string type of fixed size. @param padding  how shorter strings are padded
  [[nodiscard]] HdfObject text(std::size_t bytes, H5T_str_t padding) const;

  /// Closes the file. Every object in it is closed.
  void close() { file_.close(); }

 private:
  [[nodiscard]] hid_t create(Order order);

  HdfSession session_;
  HdfTarget target_;
  HdfObject driver_;
  HdfObject ofFiles_;  ///< creation properties of files; then of groups and datasets
  HdfObject ofGroups_;
  HdfObject ofDatasets_;
  HdfObject access_;
  HdfObject file_;
};

}  // namespace hexhex::io
