// HDF5 files that are written through OutputFile, and what reading takes as well (hdf_reader.cpp).
//
// HDF5 cannot close a file that it could not write, and crashes when the process ends. So to it,
// writing never fails here: what went wrong is kept and thrown by the next function of this header,
// and what is written afterwards is lost.
#pragma once

#include <cstdint>
#include <exception>
#include <hdf5.h>
#include <initializer_list>
#include <mutex>
#include <string>
#include <utility>

#include <io/core/hdf5_library.hpp>
#include <io/core/output_file.hpp>

/// HDF5(H5Dwrite) is that function, HDF5(H5T_NATIVE_INT32_g) that value of the library.
#if defined(HEXHEX_HDF5_NAME)
#define HDF5(name)                                                                                 \
  (*[] {                                                                                           \
    static const auto symbol = reinterpret_cast<decltype(&::name)>(hexhex::io::hdf5Symbol(#name)); \
    return symbol;                                                                                 \
  }())
// Constants of its headers call it to see whether it is ready.
#undef H5OPEN
#undef H5CHECK
#define H5OPEN
#define H5CHECK
#else
#define HDF5(name) ::name
#endif

namespace hexhex::io {

/// Where HDF5 writes or reads, and what went wrong there.
struct HdfTarget {
  const OutputFile* output = nullptr;  ///< null of a file that is read
  std::string name = {};               ///< of that
  std::exception_ptr failure = nullptr;

  /// Throws what went wrong, if anything.
  /// @param status  of a call of HDF5: negative if it failed
  void require(std::int64_t status) const;
};

/// An open object of HDF5. Every function throws as HdfTarget::require().
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
  /// Closes it now, since closing may fail, too.
  void close();

 private:
  const HdfTarget& target_;
  hid_t id_;
  Close close_;
};

/// While it lives, no other thread uses HDF5 through this library, and HDF5 prints no errors.
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

/// A file that is being written, in a session. Its bytes follow from what is written, not from
/// when.
class HdfFile {
 public:
  /// Whether groups know the order of their members; a newer layout then.
  enum class Order : bool { OfNames, OfCreation };

  HdfFile(const OutputFile& output, Order order);
  ~HdfFile();
  HdfFile(const HdfFile&) = delete;
  HdfFile& operator=(const HdfFile&) = delete;

  [[nodiscard]] hid_t root() const noexcept { return file_.id(); }
  [[nodiscard]] HdfObject group(hid_t parent, const std::string& name) const;
  /// @param shape  none: a single value
  [[nodiscard]] HdfObject space(std::initializer_list<hsize_t> shape) const;
  [[nodiscard]] HdfObject dataset(hid_t parent, const std::string& name, hid_t type,
                                  const HdfObject& space) const;
  /// A dataset without rows, to which append() adds some. @param components  of a row; 1: numbers
  [[nodiscard]] HdfObject growing(hid_t parent, const std::string& name, hid_t type,
                                  hsize_t components) const;
  /// Writes rows behind the last one.
  /// @param rows  that there are; counted on
  void append(const HdfObject& set, hid_t memoryType, hsize_t components, hsize_t& rows,
              const void* values, hsize_t count) const;
  /// A dataset whose values lie one behind the other, from that byte of the file on, and are not
  /// written: others do that.
  [[nodiscard]] std::uint64_t reserve(hid_t parent, const std::string& name, hid_t type,
                                      hsize_t rows, hsize_t components) const;
  void writeAttribute(hid_t object, const char* name, hid_t type, const HdfObject& space,
                      const void* values) const;
  /// A type of text of so many bytes. @param padding  what is behind shorter texts
  [[nodiscard]] HdfObject text(std::size_t bytes, H5T_str_t padding) const;

  /// Closes the file. Every object in it is closed.
  void close() { file_.close(); }

 private:
  [[nodiscard]] hid_t create(Order order);

  HdfSession session_;
  HdfTarget target_;
  HdfObject driver_;
  HdfObject ofFiles_;  ///< how they are created, as the next two
  HdfObject ofGroups_;
  HdfObject ofDatasets_;
  HdfObject access_;
  HdfObject file_;
};

}  // namespace hexhex::io
