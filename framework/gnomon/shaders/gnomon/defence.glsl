// GNOMON_DEFENCE(name): a named guard against a numerical hard case. It is `true`, or `false` where tests or `--without name`
// switch the guard off to show what it is for. It is no macro: gl/program.cpp writes the value into the text that is compiled.
// Names are declared, with their meaning, in technique/defences.cpp, or in the notes of the plugin's entry.
