// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_list.h"

#include <sstream>

#include "cli/global_options.h"
#include "cli/help_format.h"

namespace hairloom::cli {
namespace {

Report choicesOf(const OptionValues& values) {
    Report choices = Report::array();
    std::istringstream list(values.choices);
    for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
    return choices;
}

Report described(const CLI::Option& option) {
    const OptionValues values = valuesOf(option);
    const bool placed = option.get_positional();
    const bool flag = option.get_items_expected_max() == 0;
    Report described;
    described["name"] = placed ? option.get_name(true) : option.get_lnames().front();
    described["argument"] = placed ? Report() : Report("--" + option.get_lnames().front());
    described["type"] = flag ? "FLAG" : values.type;
    described["choices"] = choicesOf(values);
    described["many"] = option.get_items_expected_max() > 1;
    described["required"] = option.get_required();
    described["default"] = option.get_default_str().empty() ? Report() : Report(option.get_default_str());
    described["meaning"] = meaningOf(option);
    return described;
}

void addOptions(const CLI::App& app, Report& options) {
    for (const CLI::Option* option : app.get_options()) {
        const bool named = option->get_positional() || !option->get_lnames().empty();
        if (!named || option->get_name() == "--help" || option->get_description().empty()) continue;
        options.push_back(described(*option));
    }
    // Groups of options are apps without a name.
    for (const CLI::App* group :
         app.get_subcommands([](const CLI::App* part) { return part->get_name().empty(); }))
        addOptions(*group, options);
}

}  // namespace

Report describedJobs() {
    CLI::App program;
    GlobalOptions global;
    addGlobalOptions(program, global);
    Report all{{"options", Report::array()}, {"jobs", Report::array()}};
    addOptions(program, all["options"]);
    for (const Job& job : jobs()) {
        CLI::App& app = *program.add_subcommand(job.name);
        declareJob(job, app);
        Report row{{"name", job.name},
                   {"does", job.does},
                   {"example", "hairloom-cli " + job.name + " " + job.example},
                   {"options", Report::array()}};
        addOptions(app, row["options"]);
        all["jobs"].push_back(std::move(row));
    }
    return all;
}

}  // namespace hairloom::cli
