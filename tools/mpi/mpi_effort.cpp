#include "tools/mpi/mpi_effort.hpp"

#include <mpi.h>

#include <ctime>
#include <map>

// MPI's interface for profiling (MPI 4.0, section 15.2): a program may define MPI_X, which all libraries then call, and
// do its work by PMPI_X. One thread talks at a time, so that nothing here is guarded.

namespace minamo {

namespace {

Effort counted;                                  // but for compute
double in_talk = 0;                              // [s]
int depth = 0;                                   // MPI may call itself
std::map<MPI_Request, std::int64_t> persistent;  // bytes of sends that are started again and again

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// While it lives this thread talks.
class Talk {
 public:
  Talk() : begin_(depth++ == 0 ? seconds(CLOCK_THREAD_CPUTIME_ID) : 0) {}
  ~Talk() {
    if (--depth == 0) in_talk += seconds(CLOCK_THREAD_CPUTIME_ID) - begin_;
  }
  Talk(const Talk&) = delete;
  Talk& operator=(const Talk&) = delete;

 private:
  double begin_;
};

std::int64_t bytes_of(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<std::int64_t>(count) * size;
}

void count_message(std::int64_t bytes) {
  ++counted.messages;
  counted.bytes += bytes;
}

}  // namespace

Effort mpi_effort() {
  Effort all = counted;
  all.compute = seconds(CLOCK_PROCESS_CPUTIME_ID) - in_talk;
  return all;
}

}  // namespace minamo

// NOLINTBEGIN(readability-identifier-naming): names of MPI
using minamo::bytes_of;
using minamo::count_message;
using minamo::counted;
using minamo::persistent;
using minamo::Talk;

#define MINAMO_TALK(name, parameters, arguments) \
  int MPI_##name parameters {                    \
    const Talk talk;                             \
    return PMPI_##name arguments;                \
  }
#define MINAMO_COLLECTIVE(name, parameters, arguments) \
  int MPI_##name parameters {                          \
    const Talk talk;                                   \
    ++counted.collectives;                             \
    return PMPI_##name arguments;                      \
  }
#define MINAMO_SEND(name, parameters, arguments) \
  int MPI_##name parameters {                    \
    const Talk talk;                             \
    count_message(bytes_of(count, type));        \
    return PMPI_##name arguments;                \
  }

extern "C" {

MINAMO_SEND(Send, (const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm),
            (data, count, type, to, tag, comm))
MINAMO_SEND(Isend,
            (const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request),
            (data, count, type, to, tag, comm, request))
MINAMO_SEND(Issend,
            (const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request),
            (data, count, type, to, tag, comm, request))
MINAMO_SEND(Irsend,
            (const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request),
            (data, count, type, to, tag, comm, request))

int MPI_Send_init(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
                  MPI_Request* request) {
  const int code = PMPI_Send_init(data, count, type, to, tag, comm, request);
  persistent[*request] = bytes_of(count, type);
  return code;
}
int MPI_Startall(int count, MPI_Request* requests) {
  const Talk talk;
  for (int k = 0; k < count; ++k) {
    if (const auto sent = persistent.find(requests[k]); sent != persistent.end()) count_message(sent->second);
  }
  return PMPI_Startall(count, requests);
}
int MPI_Request_free(MPI_Request* request) {
  persistent.erase(*request);
  return PMPI_Request_free(request);
}

MINAMO_COLLECTIVE(Allreduce, (const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm),
                  (in, out, count, type, op, comm))
MINAMO_COLLECTIVE(Iallreduce,
                  (const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm,
                   MPI_Request* request),
                  (in, out, count, type, op, comm, request))
MINAMO_COLLECTIVE(Reduce, (const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm),
                  (in, out, count, type, op, root, comm))
MINAMO_COLLECTIVE(Scan, (const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm),
                  (in, out, count, type, op, comm))
MINAMO_COLLECTIVE(Exscan, (const void* in, void* out, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm),
                  (in, out, count, type, op, comm))
MINAMO_COLLECTIVE(Allgather,
                  (const void* in, int count, MPI_Datatype type, void* out, int counts, MPI_Datatype types,
                   MPI_Comm comm),
                  (in, count, type, out, counts, types, comm))
MINAMO_COLLECTIVE(Allgatherv,
                  (const void* in, int count, MPI_Datatype type, void* out, const int* counts, const int* begins,
                   MPI_Datatype types, MPI_Comm comm),
                  (in, count, type, out, counts, begins, types, comm))
MINAMO_COLLECTIVE(Gather,
                  (const void* in, int count, MPI_Datatype type, void* out, int counts, MPI_Datatype types, int root,
                   MPI_Comm comm),
                  (in, count, type, out, counts, types, root, comm))
MINAMO_COLLECTIVE(Gatherv,
                  (const void* in, int count, MPI_Datatype type, void* out, const int* counts, const int* begins,
                   MPI_Datatype types, int root, MPI_Comm comm),
                  (in, count, type, out, counts, begins, types, root, comm))
MINAMO_COLLECTIVE(Bcast, (void* data, int count, MPI_Datatype type, int root, MPI_Comm comm),
                  (data, count, type, root, comm))
MINAMO_COLLECTIVE(Alltoall,
                  (const void* in, int count, MPI_Datatype type, void* out, int counts, MPI_Datatype types,
                   MPI_Comm comm),
                  (in, count, type, out, counts, types, comm))
MINAMO_COLLECTIVE(Barrier, (MPI_Comm comm), (comm))
MINAMO_COLLECTIVE(Ibarrier, (MPI_Comm comm, MPI_Request* request), (comm, request))

MINAMO_TALK(Recv, (void* data, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Status* status),
            (data, count, type, from, tag, comm, status))
MINAMO_TALK(Irecv, (void* data, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Request* request),
            (data, count, type, from, tag, comm, request))
MINAMO_TALK(Probe, (int from, int tag, MPI_Comm comm, MPI_Status* status), (from, tag, comm, status))
MINAMO_TALK(Iprobe, (int from, int tag, MPI_Comm comm, int* is_there, MPI_Status* status),
            (from, tag, comm, is_there, status))
MINAMO_TALK(Wait, (MPI_Request * request, MPI_Status* status), (request, status))
MINAMO_TALK(Waitall, (int count, MPI_Request* requests, MPI_Status* statuses), (count, requests, statuses))
MINAMO_TALK(Waitany, (int count, MPI_Request* requests, int* which, MPI_Status* status),
            (count, requests, which, status))
MINAMO_TALK(Waitsome, (int count, MPI_Request* requests, int* done, int* which, MPI_Status* statuses),
            (count, requests, done, which, statuses))
MINAMO_TALK(Test, (MPI_Request * request, int* is_done, MPI_Status* status), (request, is_done, status))
MINAMO_TALK(Testall, (int count, MPI_Request* requests, int* is_done, MPI_Status* statuses),
            (count, requests, is_done, statuses))
MINAMO_TALK(File_write_at_all,
            (MPI_File file, MPI_Offset at, const void* data, int count, MPI_Datatype type, MPI_Status* status),
            (file, at, data, count, type, status))
MINAMO_TALK(File_open, (MPI_Comm comm, const char* path, int mode, MPI_Info info, MPI_File* file),
            (comm, path, mode, info, file))
MINAMO_TALK(File_sync, (MPI_File file), (file))
MINAMO_TALK(File_close, (MPI_File * file), (file))
}
// NOLINTEND(readability-identifier-naming)
