(* SHA-256 (FIPS 180-4) of a text, in hexadecimal digits. *)

(* The first 32 bits of the fractional parts of roots of the first primes. *)
let primes =
  let rec from n found count =
    if count = 64 then List.rev found
    else if List.exists (fun p -> n mod p = 0) found then from (n + 1) found count
    else from (n + 1) (n :: found) (count + 1) in
  from 2 [] 0

let root_bits k n =
  let shifted = Z.shift_left (Z.of_int n) (32 * k) in
  Z.to_int (Z.logand (Z.root shifted k) (Z.of_string "0xffffffff"))

let constants = Array.of_list (List.map (root_bits 3) primes)
let start = Array.of_list (List.filteri (fun i _ -> i < 8) (List.map (root_bits 2) primes))

let digest text =
  let word x = x land 0xffffffff in
  let rotate x n = word ((x lsr n) lor (x lsl (32 - n))) in
  let length = String.length text in
  let padded = Bytes.make ((length + 72) / 64 * 64) '\000' in
  Bytes.blit_string text 0 padded 0 length;
  Bytes.set padded length '\x80';
  Bytes.set_int64_be padded (Bytes.length padded - 8) (Int64.of_int (8 * length));
  let hash = Array.copy start and w = Array.make 64 0 in
  for block = 0 to Bytes.length padded / 64 - 1 do
    for i = 0 to 15 do w.(i) <- Int32.to_int (Bytes.get_int32_be padded (64 * block + 4 * i)) land 0xffffffff done;
    for i = 16 to 63 do
      let a = w.(i - 15) and b = w.(i - 2) in
      let s0 = rotate a 7 lxor rotate a 18 lxor (a lsr 3) and s1 = rotate b 17 lxor rotate b 19 lxor (b lsr 10) in
      w.(i) <- word (w.(i - 16) + s0 + w.(i - 7) + s1)
    done;
    let v = Array.copy hash in
    for i = 0 to 63 do
      let a = v.(0) and e = v.(4) in
      let s1 = rotate e 6 lxor rotate e 11 lxor rotate e 25 and choice = (e land v.(5)) lxor (lnot e land v.(6)) in
      let t1 = v.(7) + s1 + word choice + constants.(i) + w.(i) in
      let s0 = rotate a 2 lxor rotate a 13 lxor rotate a 22 in
      let majority = (a land v.(1)) lxor (a land v.(2)) lxor (v.(1) land v.(2)) in
      Array.blit v 0 v 1 7;
      v.(4) <- word (v.(4) + t1);
      v.(0) <- word (t1 + s0 + majority)
    done;
    Array.iteri (fun i x -> hash.(i) <- word (x + v.(i))) hash
  done;
  String.concat "" (List.map (Printf.sprintf "%08x") (Array.to_list hash))
