#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <new>

#include <hexhex/error.hpp>

#include <io/core/hdf_file.hpp>
#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif

namespace hexhex::io {
namespace {

/// An open file of the driver. HDF5 requires its own struct as the first member.
struct OpenFile {
  H5FD_t ofHdf;
  HdfTarget* target;
  haddr_t allocated;  ///< end of the bytes that HDF5 has allocated
  haddr_t written;    ///< end of the bytes written
};

OpenFile& fileOf(H5FD_t* file) { return *reinterpret_cast<OpenFile*>(file); }
const OpenFile& fileOf(const H5FD_t* file) { return *reinterpret_cast<const OpenFile*>(file); }

/// Calls f() unless an earlier call failed, and stores an exception in the target.
template <class F>
void guarded(HdfTarget& target, const F& f) noexcept {
  if (target.failure) return;
  try {
    f();
  } catch (...) {
    target.failure = std::current_exception();
  }
}

H5FD_t* openFile(const char* /*name*/, unsigned /*flags*/, hid_t access, haddr_t /*most*/) {
  const auto* const target = static_cast<HdfTarget* const*>(HDF5(H5Pget_driver_info)(access));
  auto* const file = target == nullptr ? nullptr : new (std::nothrow) OpenFile{};
  if (file == nullptr) return nullptr;
  file->target = *target;
  return &file->ofHdf;
}

herr_t closeFile(H5FD_t* file) {
  delete &fileOf(file);
  return 0;
}

herr_t listFeatures(const H5FD_t* /*file*/, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t allocatedIn(const H5FD_t* file, H5FD_mem_t /*type*/) { return fileOf(file).allocated; }
herr_t allocateIn(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t end) {
  fileOf(file).allocated = end;
  return 0;
}
haddr_t writtenOf(const H5FD_t* file, H5FD_mem_t /*type*/) { return fileOf(file).written; }

herr_t readBytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t from,
                 std::size_t size, void* bytes) {
  const OpenFile& open = fileOf(file);
  const std::size_t there =
      from < open.written ? std::min<std::size_t>(size, open.written - from) : 0;
  std::fill_n(static_cast<char*>(bytes), size, char{0});
  guarded(*open.target, [&] { open.target->output->readBytesAt(from, bytes, there); });
  return 0;
}

herr_t writeBytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t to,
                  std::size_t size, const void* bytes) {
  OpenFile& open = fileOf(file);
  guarded(*open.target, [&] { open.target->output->writeBytesAt(to, bytes, size); });
  open.written = std::max<haddr_t>(open.written, to + size);
  return 0;
}

/// Readers expect the file to be as long as its allocated size.
herr_t makeLong(H5FD_t* file, hid_t transfer, hbool_t /*closing*/) {
  const OpenFile& open = fileOf(file);
  if (open.written >= open.allocated) return 0;
  return writeBytes(file, H5FD_MEM_DEFAULT, transfer, open.allocated - 1, 1, "");
}

H5FD_class_t driverClass() {
  constexpr H5FD_mem_t kMap[] = H5FD_FLMAP_DICHOTOMY;
  H5FD_class_t driver{};
#if defined(H5FD_CLASS_VERSION)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = 600;  // in the range for unregistered drivers
#endif
  driver.name = "hexhex";
  driver.maxaddr = std::numeric_limits<std::int64_t>::max();
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(void*);  // the target
  driver.open = openFile;
  driver.close = closeFile;
  driver.query = listFeatures;
  driver.get_eoa = allocatedIn;
  driver.set_eoa = allocateIn;
  driver.get_eof = writtenOf;
  driver.read = readBytes;
  driver.write = writeBytes;
  driver.truncate = makeLong;
  std::copy(std::begin(kMap), std::end(kMap), std::begin(driver.fl_map));
  return driver;
}

/// Throws std::bad_alloc if there is no more memory than HDF5 may need: it crashes if an allocation
/// fails halfway.
void requireSpareMemory() {
  constexpr std::size_t kMost = std::size_t{1} << 24;  // its caches take 2 MB to 4 MB
  const Array<char> spare(kMost);
}

/// HDF5 keeps its state in global variables, so one thread uses it at a time.
std::mutex& hdf5Lock() {
  static std::mutex lock;
  return lock;
}

hid_t registerDriver() {
  const H5FD_class_t driver = driverClass();
  return HDF5(H5FDregister)(&driver);
}

}  // namespace

void HdfTarget::require(std::int64_t status) const {
  if (failure) std::rethrow_exception(failure);
  if (status >= 0) return;
  if (output != nullptr) output->fail("HDF5 could not make it; perhaps memory is exhausted");
  throw Error(ErrorCode::FileSyntax,
              name +
                  ": HDF5 cannot read the file: it is damaged or incomplete, or memory is "
                  "exhausted.");
}

void HdfObject::close() {
  const hid_t id = id_;
  id_ = -1;
  require(close_(id));
}

HdfSession::HdfSession() : lock_((requireSpareMemory(), hdf5Lock())) {
  HDF5(H5Eget_auto2)(H5E_DEFAULT, &function_, &data_);
  HDF5(H5Eset_auto2)(H5E_DEFAULT, nullptr, nullptr);
}
HdfSession::~HdfSession() { HDF5(H5Eset_auto2)(H5E_DEFAULT, function_, data_); }

HdfFile::HdfFile(const OutputFile& output, Order order)
    : target_{.output = &output},
      driver_(target_, registerDriver(), HDF5(H5FDunregister)),
      ofFiles_(target_, HDF5(H5Pcreate)(HDF5(H5P_CLS_FILE_CREATE_ID_g)), HDF5(H5Pclose)),
      ofGroups_(target_, HDF5(H5Pcreate)(HDF5(H5P_CLS_GROUP_CREATE_ID_g)), HDF5(H5Pclose)),
      ofDatasets_(target_, HDF5(H5Pcreate)(HDF5(H5P_CLS_DATASET_CREATE_ID_g)), HDF5(H5Pclose)),
      access_(target_, HDF5(H5Pcreate)(HDF5(H5P_CLS_FILE_ACCESS_ID_g)), HDF5(H5Pclose)),
      file_(target_, create(order), HDF5(H5Fclose)) {}

HdfFile::~HdfFile() = default;

hid_t HdfFile::create(Order order) {
  for (const HdfObject* const creation : {&ofFiles_, &ofGroups_, &ofDatasets_}) {
    creation->require(HDF5(H5Pset_obj_track_times)(creation->id(), false));
  }
  if (order == Order::OfCreation) {
    constexpr unsigned kKnown = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
    ofFiles_.require(HDF5(H5Pset_link_creation_order)(ofFiles_.id(), kKnown));
    ofGroups_.require(HDF5(H5Pset_link_creation_order)(ofGroups_.id(), kKnown));
    access_.require(HDF5(H5Pset_libver_bounds)(access_.id(), H5F_LIBVER_V18, H5F_LIBVER_V18));
  }
  HdfTarget* const target = &target_;
  access_.require(HDF5(H5Pset_driver)(access_.id(), driver_.id(), &target));
  return HDF5(H5Fcreate)("hexhex", H5F_ACC_TRUNC, ofFiles_.id(), access_.id());
}

HdfObject HdfFile::group(hid_t parent, const std::string& name) const {
  return {target_, HDF5(H5Gcreate2)(parent, name.c_str(), H5P_DEFAULT, ofGroups_.id(), H5P_DEFAULT),
          HDF5(H5Gclose)};
}

HdfObject HdfFile::space(std::initializer_list<hsize_t> shape) const {
  const int rank = static_cast<int>(shape.size());
  return {target_,
          rank == 0 ? HDF5(H5Screate)(H5S_SCALAR)
                    : HDF5(H5Screate_simple)(rank, shape.begin(), nullptr),
          HDF5(H5Sclose)};
}

HdfObject HdfFile::dataset(hid_t parent, const std::string& name, hid_t type,
                           const HdfObject& space) const {
  return {target_,
          HDF5(H5Dcreate2)(parent, name.c_str(), type, space.id(), H5P_DEFAULT, ofDatasets_.id(),
                           H5P_DEFAULT),
          HDF5(H5Dclose)};
}

HdfObject HdfFile::growing(hid_t parent, const std::string& name, hid_t type,
                           hsize_t components) const {
  constexpr hsize_t kChunkRows = hsize_t{1} << 14;
  const int rank = components == 1 ? 1 : 2;
  const std::array<hsize_t, 2> none = {0, components};
  const std::array<hsize_t, 2> most = {H5S_UNLIMITED, components};
  const std::array<hsize_t, 2> chunk = {kChunkRows, components};
  const HdfObject rows(target_, HDF5(H5Screate_simple)(rank, none.data(), most.data()),
                       HDF5(H5Sclose));
  const HdfObject creation(target_, HDF5(H5Pcopy)(ofDatasets_.id()), HDF5(H5Pclose));
  creation.require(HDF5(H5Pset_chunk)(creation.id(), rank, chunk.data()));
  return {target_,
          HDF5(H5Dcreate2)(parent, name.c_str(), type, rows.id(), H5P_DEFAULT, creation.id(),
                           H5P_DEFAULT),
          HDF5(H5Dclose)};
}

void HdfFile::append(const HdfObject& set, hid_t memoryType, hsize_t components, hsize_t& rows,
                     const void* values, hsize_t count) const {
  if (count == 0) return;
  const int rank = components == 1 ? 1 : 2;
  const std::array<hsize_t, 2> begin = {rows, 0};
  const std::array<hsize_t, 2> added = {count, components};
  const std::array<hsize_t, 2> all = {rows + count, components};
  set.require(HDF5(H5Dset_extent)(set.id(), all.data()));
  const HdfObject place(target_, HDF5(H5Dget_space)(set.id()), HDF5(H5Sclose));
  place.require(HDF5(H5Sselect_hyperslab)(place.id(), H5S_SELECT_SET, begin.data(), nullptr,
                                          added.data(), nullptr));
  const HdfObject from(target_, HDF5(H5Screate_simple)(rank, added.data(), nullptr),
                       HDF5(H5Sclose));
  set.require(HDF5(H5Dwrite)(set.id(), memoryType, from.id(), place.id(), H5P_DEFAULT, values));
  rows += count;
}

std::uint64_t HdfFile::reserve(hid_t parent, const std::string& name, hid_t type, hsize_t rows,
                               hsize_t components) const {
  const HdfObject creation(target_, HDF5(H5Pcopy)(ofDatasets_.id()), HDF5(H5Pclose));
  creation.require(HDF5(H5Pset_alloc_time)(creation.id(), H5D_ALLOC_TIME_EARLY));
  creation.require(HDF5(H5Pset_fill_time)(creation.id(), H5D_FILL_TIME_NEVER));
  const HdfObject shape = components == 1 ? space({rows}) : space({rows, components});
  const HdfObject set(target_,
                      HDF5(H5Dcreate2)(parent, name.c_str(), type, shape.id(), H5P_DEFAULT,
                                       creation.id(), H5P_DEFAULT),
                      HDF5(H5Dclose));
  return HDF5(H5Dget_offset)(set.id());
}

void HdfFile::writeAttribute(hid_t object, const char* name, hid_t type, const HdfObject& space,
                             const void* values) const {
  HdfObject attribute(target_,
                      HDF5(H5Acreate2)(object, name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                      HDF5(H5Aclose));
  attribute.require(HDF5(H5Awrite)(attribute.id(), type, values));
}

HdfObject HdfFile::text(std::size_t bytes, H5T_str_t padding) const {
  HdfObject type(target_, HDF5(H5Tcopy)(HDF5(H5T_C_S1_g)), HDF5(H5Tclose));
  type.require(HDF5(H5Tset_size)(type.id(), bytes));
  type.require(HDF5(H5Tset_strpad)(type.id(), padding));
  return type;
}

}  // namespace hexhex::io
