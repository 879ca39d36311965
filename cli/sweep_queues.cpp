// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_queues.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "core/base/file.h"
#include "importers/child_process.h"
#include "importers/reader_security.h"

namespace hairloom::cli {
namespace {

namespace fs = std::filesystem;

/// As one word of a shell.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

std::size_t chunkOf(const QueueOptions& options, std::size_t parts) {
    // Slurm refuses arrays of more, unless it is told otherwise (MaxArraySize).
    constexpr std::size_t kTasks = 1000;
    return std::max<std::size_t>(options.chunk > 0 ? options.chunk : (parts + kTasks - 1) / kTasks, 1);
}

std::string program() {
    return (programFolder() / "hairloom-cli").string();
}
/// Parts take the user's word on readers that cannot be confined.
std::string unconfined() {
    return areUnconfinedReadersAllowed() ? " --allow-unconfined" : "";
}
std::string fileOf(const SweepFolder& folder) {
    return (folder.sweep().folder / fs::path(folder.sweep().file).filename()).string();
}

std::string arrayScript(const SweepFolder& folder, const fs::path& logs, std::size_t chunk,
                        std::size_t tasks) {
    const std::size_t parts = folder.sweep().parts.size();
    std::string log = (logs / "%A_%a.log").string();
    return fmt::format(
        "#!/bin/bash\n"
        "# Parts of the sweep {name}: `sbatch {script}` runs what is missing.\n"
        "#SBATCH --job-name=\"hairloom-{name}\"\n"
        "#SBATCH --array=0-{last}\n"
        "#SBATCH --output=\"{log}\"\n"
        "#SBATCH --open-mode=append\n"
        "#SBATCH --requeue\n"
        "first=$((SLURM_ARRAY_TASK_ID * {chunk}))\n"
        "last=$((first + {chunk} - 1))\n"
        "[ \"$last\" -lt {parts} ] || last={lastPart}\n"
        "exec {program} sweep{unconfined} --output={out} --parts=\"$first-$last\" "
        "--threads=\"${{SLURM_CPUS_PER_TASK:-1}}\" "
        "--progress=lines -- {file}\n",
        fmt::arg("name", folder.sweep().name), fmt::arg("script", (logs / "array.sh").string()),
        fmt::arg("last", tasks - 1), fmt::arg("log", log), fmt::arg("chunk", chunk), fmt::arg("parts", parts),
        fmt::arg("lastPart", parts - 1), fmt::arg("program", quoted(program())),
        fmt::arg("unconfined", unconfined()), fmt::arg("out", quoted(folder.path().string())),
        fmt::arg("file", quoted(fileOf(folder))));
}

std::string mergeScript(const SweepFolder& folder, const fs::path& logs) {
    return fmt::format(
        "#!/bin/bash\n"
        "#SBATCH --job-name=\"hairloom-{}-merge\"\n"
        "#SBATCH --output=\"{}\"\n"
        "exec {} sweep{} --output={} --merge -- {}\n",
        folder.sweep().name, (logs / "merge_%j.log").string(), quoted(program()), unconfined(),
        quoted(folder.path().string()), quoted(fileOf(folder)));
}

/// The number that sbatch gives the job.
Result<std::string> sbatch(const std::vector<std::string>& arguments) {
    constexpr std::string_view kMissing = "no sbatch", kStatus = "status ";
    const std::string script = fmt::format(
        "command -v sbatch >/dev/null || {{ echo '{}'; exit; }}; sbatch \"$@\" 2>&1; echo \"{}$?\"", kMissing,
        kStatus);
    std::vector<std::string> words{"-c", script, "sbatch", "--parsable"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    ChildLimits limits;
    limits.time = std::chrono::minutes(2);
    limits.startsPrograms = true;
    const auto output = runChild("sbatch", "/bin/sh", words, limits);
    if (!output) return tl::unexpected(output.error());
    std::string text(reinterpret_cast<const char*>(output->data()), output->size());
    if (text.starts_with(kMissing))
        return fail("there is no queue: the program sbatch was not found",
                    "expected Slurm's programs in PATH; the scripts are written, and run where these are");
    const auto status = text.rfind(kStatus);
    const bool ok = status != std::string::npos && text.substr(status + kStatus.size()).starts_with("0");
    text.resize(std::min(status, text.size()));
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
    if (!ok) return fail("Slurm takes no job: " + text, "expected a controller that runs (sinfo)");
    // A site's own words may come before, and a cluster's name may follow.
    if (const auto line = text.rfind('\n'); line != std::string::npos) text.erase(0, line + 1);
    return text.substr(0, text.find(';'));
}

}  // namespace

Result<Report> submitToSlurm(const SweepFolder& folder, const QueueOptions& options) {
    const fs::path logs = folder.path() / "slurm";
    for (const std::string& path : {logs.string(), folder.sweep().name})
        if (path.find_first_of("%\"\n\\") != std::string::npos)
            return failIn(folder.path().string(), {}, "has a character in its name that Slurm reads as more",
                          "expected no %, \", \\ or line break");
    const std::size_t parts = folder.sweep().parts.size(), chunk = chunkOf(options, parts);
    const std::size_t tasks = (parts + chunk - 1) / chunk;
    const auto files = writeFiles(logs, {{"array.sh", arrayScript(folder, logs, chunk, tasks)},
                                         {"merge.sh", mergeScript(folder, logs)}});
    if (!files) return tl::unexpected(files.error());
    Report report{{"tasks", tasks},
                  {"script", (logs / "array.sh").string()},
                  {"merge_script", (logs / "merge.sh").string()},
                  {"array_job", nullptr},
                  {"merge_job", nullptr}};
    if (!options.submit) return report;
    std::vector<std::string> words = options.sbatch;
    words.push_back((logs / "array.sh").string());
    const auto array = sbatch(words);
    if (!array) return tl::unexpected(array.error());
    // Not afterok, which waits for ever where a task failed: merging tells which parts are missing.
    words.insert(words.end() - 1, "--dependency=afterany:" + *array);
    words.back() = (logs / "merge.sh").string();
    const auto merge = sbatch(words);
    if (!merge) return tl::unexpected(merge.error());
    report["array_job"] = *array;
    report["merge_job"] = *merge;
    return report;
}

Result<Report> writeOpenJdTemplate(const SweepFolder& folder, const fs::path& directory,
                                   const QueueOptions& options) {
    if (folder.sweep().name.find("{{") != std::string::npos)
        return failIn(folder.sweep().file, {},
                      "has {{ in its name, which Open Job Description reads as a parameter",
                      "expected another name");
    const std::size_t parts = folder.sweep().parts.size(), chunk = chunkOf(options, parts);
    const auto run = [&](std::vector<std::string> words) {
        Report arguments{"sweep", "--output", "{{Param.Output}}"};
        for (std::string& word : words) arguments.push_back(std::move(word));
        if (areUnconfinedReadersAllowed()) arguments.push_back("--allow-unconfined");
        arguments.push_back("--");
        arguments.push_back("{{Param.Sweep}}");
        return Report{
            {"actions", {{"onRun", {{"command", "{{Param.Program}}"}, {"args", std::move(arguments)}}}}}};
    };
    const Report part{{"name", "Part"},
                      {"type", "CHUNK[INT]"},
                      {"range", fmt::format("0-{}", parts - 1)},
                      {"chunks", {{"defaultTaskCount", chunk}, {"rangeConstraint", "CONTIGUOUS"}}}};
    const Report content{
        {"specificationVersion", "jobtemplate-2023-09"},
        {"extensions", Report::array({"TASK_CHUNKING"})},
        {"name", "Hairloom sweep " + folder.sweep().name},
        {"parameterDefinitions",
         Report::array(
             {Report{{"name", "Program"}, {"type", "STRING"}, {"default", program()}},
              Report{{"name", "Sweep"}, {"type", "STRING"}, {"default", fileOf(folder)}},
              Report{{"name", "Output"}, {"type", "STRING"}, {"default", folder.path().string()}}})},
        {"steps",
         Report::array({Report{{"name", "Parts"},
                               {"parameterSpace", {{"taskParameterDefinitions", Report::array({part})}}},
                               {"script", run({"--parts", "{{Task.Param.Part}}", "--progress", "openjd"})}},
                        Report{{"name", "Merge"},
                               {"dependencies", Report::array({Report{{"dependsOn", "Parts"}}})},
                               {"script", run({"--merge"})}}})}};
    const auto files = writeFiles(directory, {{"template.json", content.dump(2) + "\n"}});
    if (!files) return tl::unexpected(files.error());
    return Report{{"tasks", (parts + chunk - 1) / chunk},
                  {"template", (directory / "template.json").string()}};
}

}  // namespace hairloom::cli
