#pragma once
/// \file
/// The ranks of MPI.

#include "engine/run/communicator.hpp"

#include <memory>

namespace minamo {

/// Takes part in MPI while it lives. Where there is more than one process, all_ranks() are those of MPI.
class MpiSession {
 public:
  MpiSession();
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

 private:
  std::unique_ptr<Communicator> communicator_;
};

}  // namespace minamo
