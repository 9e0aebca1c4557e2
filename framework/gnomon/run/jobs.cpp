#include "gnomon/run/jobs.h"

#include <nlohmann/json.hpp>

namespace gnomon {
namespace {

/// The jobs of one entry for one light.
std::vector<JobRequest> expandEntry(const TechniqueChoice& choice) {
  JobRequest first;
  first.technique = choice.technique;
  first.where = choice.where.child("parameters");
  Json set = choice.parameters ? *choice.parameters : Json::object();
  for (const auto& [name, value] : set.items()) first.places[name] = first.where.child(name);
  first.parameters = std::make_shared<const Json>(std::move(set));

  std::vector<JobRequest> jobs = {first};
  if (!choice.sweep) return jobs;
  for (const auto& [name, values] : choice.sweep->items()) {
    // The reader has said what is wrong with these; the rest is still worth checking.
    if (!values.is_array() || values.empty() || values.size() > kMostSweepCombinations / jobs.size()) continue;
    std::vector<JobRequest> next;
    for (const JobRequest& job : jobs) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        JobRequest& made = next.emplace_back(job);
        Json parameters = *job.parameters;
        parameters[name] = values[i];
        made.parameters = std::make_shared<const Json>(std::move(parameters));
        made.places[name] = choice.where.child("sweep").child(name).child(i);
      }
    }
    jobs = std::move(next);
  }
  return jobs;
}

}  // namespace

std::vector<JobRequest> expandJobs(const RunConfig& config, std::size_t lights) {
  std::vector<JobRequest> jobs;
  for (std::size_t light = 0; light < lights; ++light) {
    for (std::size_t entry = 0; entry < config.techniques.size(); ++entry) {
      for (JobRequest& job : expandEntry(config.techniques[entry])) {
        job.light = light;
        job.entry = entry;
        jobs.push_back(std::move(job));
      }
    }
  }
  return jobs;
}

Problems atTheirPlaces(const Problems& problems, const JobRequest& job) {
  Problems moved;
  for (Problem problem : problems.list()) {
    for (const auto& [name, place] : job.places) {
      const std::string reported = job.where.child(name).pointer;
      const bool isHere = problem.pointer == reported || problem.pointer.rfind(reported + "/", 0) == 0;
      if (!isHere) continue;
      problem.pointer = place.pointer + problem.pointer.substr(reported.size());
      break;
    }
    moved.add(problem.file, problem.pointer, problem.message);
  }
  return moved;
}

}  // namespace gnomon
