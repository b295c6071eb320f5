"""What is wrong with FOON files, or worth a look: everything an annotator may have slipped on."""
