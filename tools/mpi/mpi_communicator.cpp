#include "tools/mpi/mpi_communicator.hpp"

#include "tools/mpi/mpi_effort.hpp"

#include <petscsys.h>

#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace minamo {

namespace {

constexpr int tag_of_friends = 1;
/// And the next: one exchange may still look for messages while the next one sends.
constexpr int tag_of_strangers = 2;

int count_of(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw std::runtime_error("mpi: a message of more than 2 GB");
  }
  return static_cast<int>(bytes);
}

/// By rows, of which there may be more than 2 GB.
bool write_piece(MPI_File file, const Communicator::Piece& piece) {
  MPI_Datatype row = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(static_cast<int>(piece.row_bytes), MPI_BYTE, &row);
  MPI_Type_commit(&row);
  const auto rows = static_cast<int>(piece.rows.size() / piece.row_bytes);
  MPI_Status status;
  const int failed =
      MPI_File_write_at_all(file, static_cast<MPI_Offset>(piece.offset), piece.rows.data(), rows, row, &status);
  int written = 0;
  MPI_Get_count(&status, row, &written);
  MPI_Type_free(&row);
  return failed == MPI_SUCCESS && written == rows;
}

class MpiCommunicator final : public Communicator {
 public:
  MpiCommunicator() {
    MPI_Comm_dup(MPI_COMM_WORLD, &comm_);
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &size_);
    MPI_Comm of_machine = MPI_COMM_NULL;
    MPI_Comm_split_type(comm_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &of_machine);
    MPI_Comm_size(of_machine, &on_this_machine_);
    MPI_Comm_free(&of_machine);
  }
  ~MpiCommunicator() override { MPI_Comm_free(&comm_); }
  MpiCommunicator(const MpiCommunicator&) = delete;
  MpiCommunicator& operator=(const MpiCommunicator&) = delete;

  using Communicator::sum;
  int on_this_machine() const override { return on_this_machine_; }
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  Effort effort() const override { return mpi_effort(); }

  /// Gathered and added up by rank: MPI_Allreduce may add in another order on every rank.
  void sum(std::span<double> values) override {
    std::vector<double> all(values.size() * static_cast<std::size_t>(size_));
    const int count = static_cast<int>(values.size());
    MPI_Allgather(values.data(), count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE, comm_);
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = 0;
      for (std::size_t r = 0; r < static_cast<std::size_t>(size_); ++r) values[k] += all[r * values.size() + k];
    }
  }
  std::int64_t sum(std::int64_t value) override {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_SUM, comm_);
    return value;
  }
  std::int64_t sum_below(std::int64_t value) override {
    std::int64_t below = 0;
    MPI_Exscan(&value, &below, 1, MPI_INT64_T, MPI_SUM, comm_);
    return rank_ == 0 ? 0 : below;
  }
  double largest(double value) override {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, comm_);
    return value;
  }
  std::string broadcast(std::string text, int root) override {
    int length = count_of(text.size());
    MPI_Bcast(&length, 1, MPI_INT, root, comm_);
    text.resize(static_cast<std::size_t>(length));
    MPI_Bcast(text.data(), length, MPI_CHAR, root, comm_);
    return text;
  }
  void abort(int exit_code) override { MPI_Abort(comm_, exit_code); }
  std::vector<std::vector<std::byte>> gather(std::vector<std::byte> bytes) override {
    const auto ranks = static_cast<std::size_t>(size_);
    const int own = count_of(bytes.size());
    std::vector<int> counts(ranks);
    MPI_Gather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, comm_);
    std::vector<std::vector<std::byte>> all;
    if (rank_ != 0) {
      MPI_Send(bytes.data(), own, MPI_BYTE, 0, tag_of_friends, comm_);
      return all;
    }
    all.resize(ranks);
    all[0] = std::move(bytes);
    for (int r = 1; r < size_; ++r) {
      auto& of_rank = all[static_cast<std::size_t>(r)];
      of_rank.resize(static_cast<std::size_t>(counts[static_cast<std::size_t>(r)]));
      MPI_Recv(of_rank.data(), counts[static_cast<std::size_t>(r)], MPI_BYTE, r, tag_of_friends, comm_,
               MPI_STATUS_IGNORE);
    }
    return all;
  }
  bool write(const std::string& path, std::span<const Piece> pieces) override {
    MPI_File file = MPI_FILE_NULL;
    const int failed = MPI_File_open(comm_, path.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file);
    if (any(failed != MPI_SUCCESS)) return false;
    bool is_written = true;
    for (const Piece& piece : pieces) is_written &= write_piece(file, piece);
    is_written &= MPI_File_sync(file) == MPI_SUCCESS;
    return (MPI_File_close(&file) == MPI_SUCCESS) && is_written;
  }
  using Communicator::exchange;
  void exchange(const std::vector<Message>& sent, std::vector<Message>& received) override {
    std::vector<MPI_Request> requests(sent.size() + received.size());
    std::size_t k = 0;
    for (Message& message : received) {
      MPI_Irecv(message.bytes.data(), count_of(message.bytes.size()), MPI_BYTE, message.rank, tag_of_friends, comm_,
                &requests[k++]);
    }
    for (const Message& message : sent) {
      MPI_Isend(message.bytes.data(), count_of(message.bytes.size()), MPI_BYTE, message.rank, tag_of_friends, comm_,
                &requests[k++]);
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  }

 protected:
  /// Hoefler, Siebert, Lumsdaine (2010), NBX: all messages have arrived when all ranks know that theirs have.
  std::vector<Message> exchange_between_strangers(const std::vector<Message>& sent) override {
    const int tag = tag_of_strangers + (is_odd_ ? 1 : 0);
    is_odd_ = !is_odd_;
    std::vector<MPI_Request> sends(sent.size());
    for (std::size_t k = 0; k < sent.size(); ++k) {
      MPI_Issend(sent[k].bytes.data(), count_of(sent[k].bytes.size()), MPI_BYTE, sent[k].rank, tag, comm_, &sends[k]);
    }
    std::vector<Message> received;
    MPI_Request barrier = MPI_REQUEST_NULL;
    for (bool is_waiting = false;;) {
      int is_there = 0;
      MPI_Status status;
      MPI_Iprobe(MPI_ANY_SOURCE, tag, comm_, &is_there, &status);
      if (is_there != 0) {
        int bytes = 0;
        MPI_Get_count(&status, MPI_BYTE, &bytes);
        Message message{status.MPI_SOURCE, std::vector<std::byte>(static_cast<std::size_t>(bytes))};
        MPI_Recv(message.bytes.data(), bytes, MPI_BYTE, status.MPI_SOURCE, tag, comm_, MPI_STATUS_IGNORE);
        received.push_back(std::move(message));
      }
      int is_done = 0;
      if (is_waiting) {
        MPI_Test(&barrier, &is_done, MPI_STATUS_IGNORE);
        if (is_done != 0) return received;
      } else {
        MPI_Testall(static_cast<int>(sends.size()), sends.data(), &is_done, MPI_STATUSES_IGNORE);
        if (is_done != 0) {
          MPI_Ibarrier(comm_, &barrier);
          is_waiting = true;
        }
      }
    }
  }

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  int on_this_machine_ = 1;
  bool is_odd_ = false;
};

}  // namespace

MpiSession::MpiSession() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (size == 1) return;  // alone it is the ordinary program, bit for bit
  PetscInitializeNoArguments();
  PetscPopSignalHandler();  // signals are ours
  communicator_ = std::make_unique<MpiCommunicator>();
  communicator_->marks_unknown = std::getenv("MINAMO_MARK_UNKNOWN") != nullptr;
  set_all_ranks(communicator_.get());
}

MpiSession::~MpiSession() {
  set_all_ranks(nullptr);
  if (communicator_) PetscFinalize();
  communicator_.reset();
  MPI_Finalize();
}

}  // namespace minamo
