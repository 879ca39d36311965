// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/man_pages.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/global_options.h"
#include "cli/help_format.h"
#include "cli/job.h"
#include "core/editing/brush_list.h"

namespace hairloom::cli {
namespace {

/// Text as troff prints it: hyphens of options can be searched for and copied.
std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
            out += std::string("\\&") + c;
        else if (c == '\n')
            out += "\n.br\n";
        else
            out += c;
    }
    return out;
}

std::string heading(std::string_view name) {
    return fmt::format(".TH {} 1 \"\" \"Hairloom {}\" \"Hairloom\"\n", name, HAIRLOOM_VERSION);
}

std::string entry(const std::string& term, const std::string& meaning) {
    return fmt::format(".TP\n.B {}\n{}\n", escaped(term), escaped(meaning));
}

void addOptions(const CLI::App& app, std::string& page) {
    for (const CLI::Option* option : app.get_options()) {
        if (option->get_name().empty() || option->get_name() == "--help" || option->get_description().empty())
            continue;
        page += entry(termOf(*option), meaningOf(*option));
    }
}

void addJob(const Job& job, std::string& page) {
    page += fmt::format(".SS {}\n{}.\n", escaped(job.name), escaped(job.does));
    CLI::App program;
    CLI::App& app = *program.add_subcommand(job.name);
    declareJob(job, app);
    addOptions(app, page);
    page += fmt::format(".PP\nExample:\n.PP\n.RS\n.EX\nhairloom\\-cli {} {}\n.EE\n.RE\n", escaped(job.name),
                        escaped(job.example));
}

}  // namespace

std::string commandLineManPage() {
    std::string page = heading("HAIRLOOM\\-CLI");
    page +=
        ".SH NAME\nhairloom\\-cli \\- author hairstyles for games, without a window\n"
        ".SH SYNOPSIS\n.B hairloom\\-cli\n.RI [ OPTIONS ]\n.I JOB\n.RI [ \"OPTIONS OF THE JOB\" ]\n"
        ".SH DESCRIPTION\nEvery job of the editor \\(em heads, scalps, grooming, simulation, images, "
        "assets "
        "\\(em\nas one command. Lengths are in metres, time in seconds, angles in degrees.\n"
        ".SH OPTIONS\n";
    CLI::App program;
    GlobalOptions options;
    addGlobalOptions(program, options);
    addOptions(program, page);
    page += ".SH JOBS\n";
    for (const Job& job : jobs()) addJob(job, page);
    page +=
        ".SH EXIT STATUS\n0 if the job is done, 1 if it failed, 2 if the command line was wrong.\n.SH "
        "ENVIRONMENT\n";
    page += entry("HAIRLOOM_SAMPLES", "Folder of sample heads and hairstyles.");
    page += entry("HAIRLOOM_WEB", "Folder of the player that export --format web writes.");
    page += ".SH SEE ALSO\n.BR hairloom (1)\n";
    return page;
}

std::string editorManPage() {
    std::string page = heading("HAIRLOOM");
    page +=
        ".SH NAME\nhairloom \\- author hairstyles for games in a window\n.SH SYNOPSIS\n.B hairloom\n.RB [ "
        "\\-\\-help ]\n.RB [ \\-\\-version ]\n.RI [ FILE ]\n.SH DESCRIPTION\nOpens a project (.hairloom), a "
        "head or a file of hair, or else the start page. Select the scalp, place roots,\ngroom strands, "
        "place collision spheres, watch the hair move, and export it.\n.SH BRUSHES\n";
    for (const std::string_view name : editing::brushNames()) {
        const editing::BrushInfo& brush = editing::brushInfo(name);
        std::string meaning(brush.meaning);
        if (!brush.inverse.empty()) meaning += fmt::format(". Inverted: {}", brush.inverse);
        page += entry(std::string(brush.label), meaning + ".");
    }
    page += ".SH SEE ALSO\n.BR hairloom\\-cli (1)\n";
    return page;
}

}  // namespace hairloom::cli
