// Jobs: what a run config asks for, one by one.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gnomon/run/config.h"

namespace gnomon {

/// One light, one technique, one set of parameter values.
struct JobRequest {
  std::size_t light = 0;
  std::size_t entry = 0;  ///< of RunConfig::techniques
  std::string technique;
  std::shared_ptr<const Json> parameters;  ///< object of those that are set and those that are swept; never null
  Location where;                          ///< of the parameters, for readers of the whole object
  std::map<std::string, Location> places;  ///< where each value stands in the file
};

/// Each light x each entry x each combination of its sweep, the first swept parameter changing slowest: the order of the file.
std::vector<JobRequest> expandJobs(const RunConfig& config, std::size_t lights);

/// Faults that a reader of `job.parameters` reported under `job.where`, moved to where the values stand in the file.
Problems atTheirPlaces(const Problems& problems, const JobRequest& job);

}  // namespace gnomon
