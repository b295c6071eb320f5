(** The checker as OCaml, with Zarith's integers in place of Coq's. *)
From Coq Require Import Extraction ExtrOcamlBasic ExtrOcamlZBigInt ZArith FMapPositive.
From Verified Require Import Amount Cuts Foon Checker.

Extract Constant Pos.eqb => "Big_int_Z.eq_big_int".

Extraction "checker.ml" PositiveMap.add PositiveMap.empty of_list accept_bound accept_tree accept_optimal accept_infeasible.
